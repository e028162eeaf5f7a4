#include "engine/sources/open_live.h"

#include <algorithm>
#include <utility>

#include "engine/sources/live_channel.h"
#include "engine/sources/openni_source.h"

namespace surefield {

LiveSource open_live(const std::string& address, const LiveOptions& options) {
  if (address == "openni2" || address.starts_with("openni2:"))
    return {open_openni(address.substr(std::min(address.size(), std::size_t{8})))};
  auto channel = std::make_unique<LiveChannel>(address);
  const std::stop_callback end_soon(options.stop, [&wanted = *channel] { wanted.stop(); });
  if (!channel->listening().empty() && options.waiting) options.waiting(channel->listening());
  if (!channel->wait_for_sender()) return {};
  LiveChannel& bytes = *channel;
  auto stream = std::make_unique<StreamSource>(std::move(channel));
  if (bytes.stopped()) return {};
  StreamSource* const known = stream.get();
  return {std::move(stream), known};
}

}  // namespace surefield
