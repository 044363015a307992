#include "framegraph/dump.h"

#include <fmt/format.h>

#include <iterator>

#include "core/json_writer.h"

namespace tyndall::fg {
namespace {

template <typename... Args>
void append(std::string& text, fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
}

std::string describe(const CompiledResource& resource) {
    if (resource.isBuffer) return "buffer";
    const TextureDesc& d = resource.texture;
    std::string text = fmt::format("{} {}×{}", formatName(d.format), d.width, d.height);
    if (d.kind == TextureKind::Tex3D) append(text, "×{}", d.depth);
    if (d.kind == TextureKind::Tex2DArray) append(text, ", {} layers", d.depth);
    if (d.mips > 1) append(text, ", {} mips", d.mips);
    return text;
}

/// "2–5", passes counted from 0; "end" where it lives to the end of the frame.
std::string lifetime(const CompiledGraph& graph, const CompiledResource& resource) {
    if (resource.firstPass == kNoIndex) return resource.used ? "kept" : "unused";
    if (resource.lastPass >= graph.passes.size()) return fmt::format("{}–end", resource.firstPass);
    return fmt::format("{}–{}", resource.firstPass, resource.lastPass);
}

std::string dumpText(const CompiledGraph& graph) {
    std::string text = fmt::format("{} passes\n", graph.passes.size());
    for (size_t i = 0; i < graph.passes.size(); ++i) {
        const CompiledPass& pass = graph.passes[i];
        append(text, "{:4} {:<8}{}", i, statusName(pass.status), pass.name);
        if (!pass.reason.empty()) append(text, " ({})", pass.reason);
        text += '\n';
        if (pass.barriers != 0)
            append(text, "              barrier {}\n", barrierNames(pass.barriers));
        for (const ResourceUse& use : graph.usesOf(pass))
            append(text, "              {:<5} {} [{}]\n", isWrite(use.access) ? "write" : "read",
                   graph.resources[use.resource].name, accessName(use.access));
    }
    append(text, "{} resources\n", graph.resources.empty() ? 0 : graph.resources.size() - 1);
    for (size_t i = 1; i < graph.resources.size(); ++i) {
        const CompiledResource& resource = graph.resources[i];
        append(text, "     {}: {}, {} bytes, {}, passes {}", resource.name, describe(resource),
               resource.bytes, originName(resource.origin), lifetime(graph, resource));
        if (resource.slot != kNoIndex) append(text, ", slot {}", resource.slot);
        text += resource.isOutput ? ", output\n" : "\n";
    }
    append(text, "{} bytes in {} pool slots ({} without sharing)\n", graph.pooledBytes(),
           graph.slots.size(), graph.unpooledBytes());
    for (const std::string& error : graph.errors) append(text, "error: {}\n", error);
    return text;
}

std::string dumpDot(const CompiledGraph& graph) {
    std::string text = "digraph frame {\n    rankdir=LR;\n    node [fontname=\"sans-serif\"];\n";
    for (size_t i = 0; i < graph.passes.size(); ++i) {
        const CompiledPass& pass = graph.passes[i];
        const bool ran = pass.status == PassStatus::Ran;
        std::string label(pass.name);
        if (!ran) append(label, "\n{}: {}", statusName(pass.status), pass.reason);
        append(text, "    pass{} [shape=box, style=\"{}\", label={}];\n", i,
               ran ? "filled" : "dashed", jsonString(label));
    }
    for (size_t i = 1; i < graph.resources.size(); ++i) {
        const CompiledResource& resource = graph.resources[i];
        append(text, "    resource{} [shape=ellipse{}, label={}];\n", i,
               resource.isOutput ? ", peripheries=2" : "", jsonString(resource.name));
    }
    for (size_t i = 0; i < graph.passes.size(); ++i)
        for (const ResourceUse& use : graph.usesOf(graph.passes[i])) {
            if (isWrite(use.access))
                append(text, "    pass{} -> resource{} [color=red];\n", i, use.resource);
            else
                append(text, "    resource{} -> pass{} [color=darkgreen];\n", use.resource, i);
        }
    return text + "}\n";
}

void writePass(JsonWriter& json, const CompiledGraph& graph, const CompiledPass& pass) {
    json.compact()
        .beginObject()
        .member("name", pass.name)
        .member("status", statusName(pass.status));
    json.member("reason", pass.reason).member("barriers", barrierNames(pass.barriers));
    json.key("uses").beginArray();
    for (const ResourceUse& use : graph.usesOf(pass)) {
        json.beginObject().member("resource", use.resource - 1);
        json.member("name", graph.resources[use.resource].name).member("version", use.version);
        json.member("access", accessName(use.access)).member("write", isWrite(use.access));
        json.endObject();
    }
    json.endArray().endObject();
}

void writeResource(JsonWriter& json, const CompiledResource& resource) {
    const auto index = [&](const char* key, uint32_t value) {
        json.key(key);
        if (value == kNoIndex)
            json.null();
        else
            json.value(value);
    };
    json.compact().beginObject().member("name", resource.name);
    json.member("kind", resource.isBuffer ? "buffer" : "texture");
    json.member("description", describe(resource)).member("bytes", resource.bytes);
    json.member("origin", originName(resource.origin));
    index("first_pass", resource.firstPass);
    index("last_pass", resource.lastPass);
    index("slot", resource.slot);
    json.member("output", bool(resource.isOutput)).endObject();
}

std::string dumpJson(const CompiledGraph& graph) {
    JsonWriter json;
    json.beginObject().key("passes").beginArray();
    for (const CompiledPass& pass : graph.passes) writePass(json, graph, pass);
    json.endArray().key("resources").beginArray();
    for (size_t i = 1; i < graph.resources.size(); ++i) writeResource(json, graph.resources[i]);
    json.endArray().member("pooled_bytes", graph.pooledBytes());
    json.member("unpooled_bytes", graph.unpooledBytes()).key("errors").beginArray();
    for (const std::string& error : graph.errors) json.value(error);
    json.endArray().endObject();
    return json.take();
}

} // namespace

std::string barrierNames(uint32_t bits) {
    static constexpr struct {
        uint32_t bit;
        const char* name;
    } kNames[] = {{0x1, "vertex"},           {0x2, "index"},
                  {0x4, "uniform"},          {0x8, "texture-fetch"},
                  {0x20, "image"},           {0x40, "command"},
                  {0x100, "texture-update"}, {0x200, "buffer-update"},
                  {0x400, "framebuffer"},    {0x800, "transform-feedback"},
                  {0x2000, "storage"},       {0x8000, "query-buffer"}};
    std::string text;
    for (const auto& entry : kNames)
        if (bits & entry.bit) append(text, "{}{}", text.empty() ? "" : " ", entry.name);
    return text;
}

Result<DumpFormat> parseDumpFormat(std::string_view name) {
    if (name == "text") return DumpFormat::Text;
    if (name == "dot") return DumpFormat::Dot;
    if (name == "json") return DumpFormat::Json;
    return Error{fmt::format("graph format '{}' is not one of text, dot, json", name)};
}

std::string dump(const CompiledGraph& graph, DumpFormat format) {
    switch (format) {
    case DumpFormat::Text: return dumpText(graph);
    case DumpFormat::Dot: return dumpDot(graph);
    case DumpFormat::Json: return dumpJson(graph);
    }
    return {};
}

} // namespace tyndall::fg
