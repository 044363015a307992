#include "renderer/free_ranges.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/content.h"

namespace tyndall {
namespace {

TEST(FreeRanges, GivesTheSmallestRangeThatIsLargeEnough) {
    FreeRanges free(20);
    EXPECT_EQ(free.take(5), 0u); // [0, 5)
    EXPECT_EQ(free.take(3), 5u); // [5, 8)
    EXPECT_EQ(free.take(4), 8u); // [8, 12)
    EXPECT_FALSE(free.take(9)) << "8 are left";
    free.give(0, 5);
    free.give(8, 4); // [8, 20) with what lies after
    EXPECT_EQ(free.take(5), 0u) << "it fits there exactly";
    EXPECT_EQ(free.take(12), 8u) << "what touches is one range";
    EXPECT_FALSE(free.take(1));
    EXPECT_EQ(free.take(0), 0u) << "nothing takes no room";
}

TEST(FreeRanges, NoPlaceIsGivenTwiceAndNoneIsLost) {
    constexpr uint32_t kSize = 500;
    FreeRanges free(kSize);
    std::mt19937 random(uint32_t(test::seed()));
    std::vector<std::pair<uint32_t, uint32_t>> taken;
    std::vector<int> owners(kSize, 0);
    for (int step = 0; step < 5000; ++step) {
        if (random() % 2 == 0) {
            const uint32_t count = 1 + random() % 40;
            const auto first = free.take(count);
            if (!first) continue;
            ASSERT_LE(*first + count, kSize);
            for (uint32_t i = 0; i < count; ++i) ASSERT_EQ(owners[*first + i]++, 0);
            taken.emplace_back(*first, count);
        } else if (!taken.empty()) {
            std::swap(taken[random() % taken.size()], taken.back());
            const auto [first, count] = taken.back();
            taken.pop_back();
            free.give(first, count);
            for (uint32_t i = 0; i < count; ++i) --owners[first + i];
        }
    }
    for (const auto& [first, count] : taken) free.give(first, count);
    EXPECT_EQ(free.take(kSize), 0u) << "all of it is one range again";
}

} // namespace
} // namespace tyndall
