#include <gtest/gtest.h>

#ifdef HELIOGRAPH_TEST_GPU
#include "tests/support/validation_listener.hpp"
#endif

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
#ifdef HELIOGRAPH_TEST_GPU
    return helio::test::runAllWithDevice();
#else
    return RUN_ALL_TESTS();
#endif
}
