#include "programs/interrupt.h"

#include <csignal>
#include <initializer_list>
#include <unistd.h>

namespace tyndall {
namespace {

volatile std::sig_atomic_t signals = 0; // the only state that a signal handler may touch

extern "C" void onSignal(int) {
    if (signals > 0) ::_exit(1); // asked twice: the user means it
    signals = 1;
}

} // namespace

void catchInterrupts() {
    struct sigaction action {};
    action.sa_handler = onSignal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (int number : {SIGINT, SIGTERM, SIGHUP}) sigaction(number, &action, nullptr);
}

bool interrupted() { return signals > 0; }

} // namespace tyndall
