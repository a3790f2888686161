#pragma once
/** @file Ctrl-C and SIGTERM: asked for between pieces of work. */

namespace helio::cli {

void handleInterrupts();
/** Whether a signal came since handleInterrupts(). */
bool interrupted();

}  // namespace helio::cli
