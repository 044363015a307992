#pragma once
// Which ranges of a row of places are free: a table in parts that come and go.

#include <cstdint>
#include <iterator>
#include <map>
#include <optional>

namespace tyndall {

/// Free ranges of [0, size), merged where they touch: what is given back is one range again, however it was taken.
class FreeRanges {
public:
    explicit FreeRanges(uint32_t size = 0) {
        if (size > 0) ranges_[0] = size;
    }

    /// The first of `count` places in a row, from the smallest range that has them; nothing where no range has.
    std::optional<uint32_t> take(uint32_t count) {
        if (count == 0) return 0;
        auto best = ranges_.end();
        for (auto range = ranges_.begin(); range != ranges_.end(); ++range)
            if (range->second >= count && (best == ranges_.end() || range->second < best->second))
                best = range;
        if (best == ranges_.end()) return {};
        const auto [first, size] = *best;
        ranges_.erase(best);
        if (size > count) ranges_[first + count] = size - count;
        return first;
    }

    /// Places that take() gave.
    void give(uint32_t first, uint32_t count) {
        if (count == 0) return;
        auto range = ranges_.emplace(first, count).first;
        if (const auto next = std::next(range);
            next != ranges_.end() && next->first == first + count) {
            range->second += next->second;
            ranges_.erase(next);
        }
        if (range == ranges_.begin()) return;
        const auto before = std::prev(range);
        if (before->first + before->second != first) return;
        before->second += range->second;
        ranges_.erase(range);
    }

private:
    std::map<uint32_t, uint32_t> ranges_; // how many are free, by the first of them
};

} // namespace tyndall
