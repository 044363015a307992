// Plugins with one fault each, chosen by macro.
#include "plugin/plugin_api.h"

#ifdef FAULT_nothing
extern "C" int tyndall_not_a_plugin() { return 0; }
#else
extern "C" __attribute__((visibility("default"))) const tyndall::plugin::PluginDescriptor*
tyndall_plugin() {
    static tyndall::plugin::PluginDescriptor descriptor{
        .name = "faulty", .create = []() -> tyndall::plugin::Plugin* { return nullptr; }};
#ifdef FAULT_abi
    descriptor.abiVersion += 1;
#endif
#ifdef FAULT_size
    descriptor.structSize += 8;
#endif
#ifdef FAULT_headers // such as a Scene with another member
    descriptor.headers ^= 1;
#endif
#ifdef FAULT_layout // such as another compiler's
    descriptor.sizes.frameInputs += 8;
#endif
#ifdef FAULT_incomplete
    descriptor.create = nullptr;
#endif
    return &descriptor;
}
#endif
