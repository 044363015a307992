#include "media/particles.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/image.h"

namespace tyndall {

namespace {

constexpr const char* kColumns[] = {"x", "y", "z", "radius", "density", "temperature"};
constexpr size_t kRequiredColumns = 5, kAllColumns = 6;

std::string_view trimmed(std::string_view text) {
    const size_t first = text.find_first_not_of(" \t\r");
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> splitLine(std::string_view line) {
    std::vector<std::string_view> values;
    while (values.size() <= kAllColumns) { // one more than any line may have is enough to refuse it
        const size_t comma = line.find(',');
        values.push_back(trimmed(line.substr(0, comma)));
        if (comma == std::string_view::npos) break;
        line.remove_prefix(comma + 1);
    }
    return values;
}

/// Short enough for a sentence, and free of anything that is not plain text.
std::string quoted(std::string_view text) {
    std::string result;
    for (const char c : text.substr(0, 40)) result += c >= 0x20 && c < 0x7f ? c : '?';
    return "'" + result + (text.size() > 40 ? "…'" : "'");
}

bool isHeader(const std::vector<std::string_view>& values) {
    if (values.size() != kRequiredColumns && values.size() != kAllColumns) return false;
    for (size_t i = 0; i < values.size(); ++i)
        if (values[i] != kColumns[i]) return false;
    return true;
}

Result<Particle> parseParticle(const std::vector<std::string_view>& values,
                               const std::string& place) {
    float numbers[kAllColumns] = {};
    for (size_t i = 0; i < values.size(); ++i) {
        const std::string_view text = values[i];
        const auto [end, error] =
            std::from_chars(text.data(), text.data() + text.size(), numbers[i]);
        if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(numbers[i]))
            return Error{fmt::format("{}: {} is {}; a finite number is needed", place, kColumns[i],
                                     quoted(text))};
    }
    if (!(numbers[3] > 0))
        return Error{fmt::format("{}: radius is {}; it must be greater than 0", place, numbers[3])};
    if (numbers[4] < 0)
        return Error{fmt::format("{}: density is {}; it must not be negative", place, numbers[4])};
    if (numbers[5] < 0)
        return Error{
            fmt::format("{}: temperature is {}; it must not be negative", place, numbers[5])};
    return Particle{{numbers[0], numbers[1], numbers[2]}, numbers[3], numbers[4], numbers[5]};
}

/// SplitMix64 (Steele, Lea and Flood 2014): the same numbers on every machine, unlike the standard's distributions.
class Random {
public:
    explicit Random(uint64_t seed) : state_(seed) {}
    double uniform() { // [0,1)
        uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    dvec3 inBall() { // by rejection: no trigonometry, whose last digit differs between libraries
        while (true) {
            const double x = uniform(), y = uniform(), z = uniform();
            const dvec3 p = 2.0 * dvec3(x, y, z) - 1.0;
            if (glm::dot(p, p) < 1) return p;
        }
    }

private:
    uint64_t state_;
};

ParticleSet makeCloud(int64_t count, uint64_t seed, double radius) {
    Random random(seed);
    struct Puff {
        dvec3 centre;
        double radius;
    };
    // Puffs get smaller towards the rim, so that the outline is lumpy and stays within the unit ball.
    std::vector<Puff> puffs;
    const int64_t puffCount = std::clamp<int64_t>(count / 48, 1, 64);
    for (int64_t i = 0; i < puffCount; ++i) {
        const dvec3 p = random.inBall() * dvec3(0.75, 0.4, 0.75);
        puffs.push_back({p, 0.95 - glm::length(p) > 0.35 ? 0.35 : 0.95 - glm::length(p)});
    }
    constexpr double kBase = -0.3; // of the ball's radius: clouds are flat below
    ParticleSet set;
    const double size = std::min(0.35, 0.5 / std::cbrt(double(count)) + 0.02);
    for (int64_t i = 0; i < count; ++i) {
        const Puff& puff =
            puffs[std::min(size_t(random.uniform() * double(puffs.size())), puffs.size() - 1)];
        dvec3 p = puff.centre + (puff.radius - 0.5 * size) * random.inBall();
        p.y = std::max(p.y, kBase);
        const double ball = size * (0.75 + 0.5 * random.uniform());
        const double reach = glm::length(p) + ball;
        if (reach > 1) p *= (1 - ball) / glm::length(p);
        set.particles.push_back(
            {vec3(radius * p), float(radius * ball), float(0.5 + 0.5 * random.uniform()), 0});
    }
    return set;
}

} // namespace

Bounds ParticleSet::bounds() const {
    Bounds bounds;
    for (const Particle& p : particles) {
        bounds.include(dvec3(p.position) - double(p.radius));
        bounds.include(dvec3(p.position) + double(p.radius));
    }
    return bounds;
}

Result<ParticleSet> parseParticles(std::string_view csv, std::string_view name) {
    if (csv.starts_with("\xef\xbb\xbf")) csv.remove_prefix(3);
    ParticleSet set;
    size_t columns = 0;
    for (size_t line = 1; !csv.empty(); ++line) {
        const size_t end = csv.find('\n');
        const std::string_view text = csv.substr(0, end);
        csv.remove_prefix(end == std::string_view::npos ? csv.size() : end + 1);
        if (trimmed(text).empty()) continue;
        const std::string place = fmt::format("'{}', line {}", name, line);
        const std::vector<std::string_view> values = splitLine(text);
        if (columns == 0) {
            if (!isHeader(values))
                return Error{fmt::format(
                    "{}: the header is {}; it must be x,y,z,radius,density or x,y,z,radius,density,temperature",
                    place, quoted(trimmed(text)))};
            columns = values.size();
            continue;
        }
        if (values.size() != columns)
            return Error{fmt::format(
                "{}: {} values; the header has {}", place,
                values.size() > kAllColumns ? "too many" : std::to_string(values.size()), columns)};
        if (set.particles.size() == kMaximumParticles)
            return Error{fmt::format("{}: more than {} particles", place, kMaximumParticles)};
        const Result<Particle> particle = parseParticle(values, place);
        if (!particle) return particle.error();
        set.particles.push_back(*particle);
    }
    if (columns == 0)
        return Error{fmt::format(
            "'{}' is empty; its first line must be x,y,z,radius,density or x,y,z,radius,density,temperature",
            name)};
    if (set.particles.empty())
        return Error{fmt::format("'{}' holds no particles, only a header", name)};
    set.hasTemperature = columns == kAllColumns;
    return set;
}

Result<ParticleSet> readParticles(const std::filesystem::path& path) {
    const Result<std::string> text = readFile(path, size_t(1) << 30);
    if (!text) return text.error();
    return parseParticles(*text, path.string());
}

Result<ParticleSet> generateParticles(std::string_view kind, int64_t count, uint64_t seed,
                                      double radius) {
    if (kind != "cloud")
        return Error{fmt::format("particles cannot be generated as {}; the one kind is 'cloud'",
                                 quoted(kind))};
    if (count < 1 || count > 1'000'000)
        return Error{fmt::format("{} particles cannot be generated; 1 to 1000000 can", count)};
    if (!(radius > 0) || !std::isfinite(radius) || radius > 1e30)
        return Error{fmt::format(
            "a cloud cannot have the radius {}; it must be greater than 0 and finite", radius)};
    return makeCloud(count, seed, radius);
}

} // namespace tyndall
