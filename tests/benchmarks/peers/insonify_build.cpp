// One build of the library, PEERS_BUILD (insonify_builds.hpp). Its types differ from other builds', so none is passed
// in or out.
#include <algorithm>
#include <memory>
#include <string_view>

#include "insonify_builds.hpp"
#include "insonify_renderer.hpp"

peers::draws peers::PEERS_BUILD(char size, const char* setting, int threads) {
    const auto& s = *std::ranges::find(workload::sizes, size, &workload::size::name);
    const auto& what = *std::ranges::find(workload::settings, std::string_view(setting),
                                          [](const workload::setting& w) { return std::string_view(w.name); });
    const auto renderer =
        std::make_shared<insonify_renderer<insonify::shadow::exact>>(workload::scene(s, what), threads);
    return [renderer](std::span<std::uint8_t> out) { renderer->render(out); };
}
