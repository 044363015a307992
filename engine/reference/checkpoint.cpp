#include "reference/checkpoint.h"

#include <fmt/format.h>

#include "core/image.h"
#include "tracing/sampler.h"

namespace tyndall::reference {
namespace {

constexpr std::string_view kMagic = "tyndall reference checkpoint 1\n";
constexpr size_t kLargestFile = size_t(1) << 38;

std::string checksum(std::string_view bytes) {
    uint64_t state = bytes.size();
    for (size_t i = 0; i < bytes.size(); i += 8) {
        uint64_t word = 0;
        for (size_t j = i; j < std::min(i + 8, bytes.size()); ++j)
            word = (word << 8) | uint8_t(bytes[j]);
        state = mixBits(state ^ word);
    }
    return fmt::format("{:016x}", state);
}

/// Up to the next line's end, which is taken, too.
std::string_view takeLine(std::string_view& rest) {
    const size_t end = rest.find('\n');
    const std::string_view line = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return line;
}

} // namespace

Result<void> writeCheckpoint(const std::filesystem::path& path, const std::string& identity,
                             const Film& film) {
    const std::string body = film.serialise();
    return writeFileAtomically(path,
                               fmt::format("{}{}\n{}\n{}", kMagic, identity, checksum(body), body));
}

Result<void> readCheckpoint(const std::filesystem::path& path, const std::string& identity,
                            Film& film) {
    const Result<std::string> content = readFile(path, kLargestFile);
    if (!content.ok()) return content.error();
    std::string_view rest = *content;
    const auto wrong = [&path](const std::string& what) {
        return Error{fmt::format("{}: {}", path.string(), what)};
    };
    if (!rest.starts_with(kMagic))
        return wrong("it is no checkpoint of this version of the reference");
    rest.remove_prefix(kMagic.size());
    const std::string_view whose = takeLine(rest), sum = takeLine(rest);
    if (whose != identity)
        return wrong(
            fmt::format("it belongs to another picture ({}); this one is {}", whose, identity));
    if (checksum(rest) != sum) return wrong("it is damaged");
    if (Result<void> taken = film.deserialise(rest); !taken.ok())
        return wrong(taken.error().message);
    return {};
}

} // namespace tyndall::reference
