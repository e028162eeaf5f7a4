#pragma once

#include <functional>
#include <stop_token>

namespace surefield {

/// From now on the first Ctrl-C (SIGINT), SIGTERM or SIGHUP (unless that is ignored, as under nohup) asks the
/// program to stop, and the second ends it at once with exit code 130. Where it has not stopped by itself
/// within two seconds, because it waits for something, it is ended too, unless keep_until_saved() was called.
void catch_interrupts();

/// Does what a first Ctrl-C does.
void interrupt();

/// Whether the user asked to stop.
bool interrupted();

/// The same as a token; its callbacks run on a thread of their own.
std::stop_token interruption();

/// What is to be done where the program is ended while it waits; nothing from keep_until_saved() on. Called
/// by the thread that watches for signals, with no other running any more that could be relied on.
void clean_up_when_ended(std::function<void()> clean_up);

/// There is something to lose: one signal lets the program take its time to save it.
void keep_until_saved();

/// Ends the program without waiting for threads that may never end; everything is saved.
[[noreturn]] void leave(int code);

}  // namespace surefield
