#include <gtest/gtest.h>

#include "support/content.h"

int main(int argc, char** argv) {
    ::testing::InitGoogleTest(&argc, argv);
    std::printf("seed %llu (TYNDALL_SEED sets it)\n",
                static_cast<unsigned long long>(tyndall::test::seed()));
    return RUN_ALL_TESTS();
}
