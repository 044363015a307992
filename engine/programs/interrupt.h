#pragma once
// Ctrl-C and SIGTERM ask a program to end; it does so at the next safe place, with nothing half written.

namespace tyndall {

/// From now on the first signal sets a flag; the second ends the program at once.
void catchInterrupts();
[[nodiscard]] bool interrupted();

} // namespace tyndall
