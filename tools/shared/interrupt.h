#pragma once

namespace surefield {

/// Makes the first Ctrl-C (SIGINT) or SIGTERM from now on set interrupted(), and the second end the program
/// at once with exit code 130.
void catch_interrupts();

/// Does what a first Ctrl-C does.
void interrupt();

/// Whether the user asked to stop.
bool interrupted();

}  // namespace surefield
