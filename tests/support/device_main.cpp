#include "tests/support/validation_listener.hpp"

#include <gtest/gtest.h>

int main(int argc, char** argv) {
    testing::InitGoogleTest(&argc, argv);
    return helio::test::runAllWithDevice();
}
