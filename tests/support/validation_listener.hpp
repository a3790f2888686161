#pragma once
/** @file Runs GPU tests so that no validation message passes unseen. */

namespace helio::test {

/** RUN_ALL_TESTS() with a listener that fails each test during which a validation message came. Afterwards
 * closes the shared device; a message then or between tests makes the run fail. */
int runAllWithDevice();

}  // namespace helio::test
