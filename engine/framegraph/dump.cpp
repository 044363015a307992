#include "framegraph/dump.h"

#include <fmt/format.h>

#include <iterator>

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

/// Quotes, backslashes and control characters escaped, as JSON and dot both want them.
std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\')
            append(result, "\\{}", c);
        else if (static_cast<unsigned char>(c) < 0x20)
            append(result, "\\u{:04x}", static_cast<unsigned char>(c));
        else
            result += c;
    }
    return result + "\"";
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
        std::string escaped = quoted(label);
        for (size_t at = escaped.find("\\u000a"); at != std::string::npos;
             at = escaped.find("\\u000a"))
            escaped.replace(at, 6, "\\n");
        append(text, "    pass{} [shape=box, style=\"{}\", label={}];\n", i,
               ran ? "filled" : "dashed", escaped);
    }
    for (size_t i = 1; i < graph.resources.size(); ++i) {
        const CompiledResource& resource = graph.resources[i];
        append(text, "    resource{} [shape=ellipse{}, label={}];\n", i,
               resource.isOutput ? ", peripheries=2" : "", quoted(resource.name));
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

void appendPassJson(std::string& text, const CompiledGraph& graph, const CompiledPass& pass) {
    append(text,
           "    {{\"name\": {}, \"status\": \"{}\", \"reason\": {}, \"barriers\": {}, \"uses\": [",
           quoted(pass.name), statusName(pass.status), quoted(pass.reason),
           quoted(barrierNames(pass.barriers)));
    const char* separator = "";
    for (const ResourceUse& use : graph.usesOf(pass)) {
        append(
            text,
            "{}{{\"resource\": {}, \"name\": {}, \"version\": {}, \"access\": \"{}\", \"write\": {}}}",
            separator, use.resource - 1, quoted(graph.resources[use.resource].name), use.version,
            accessName(use.access), isWrite(use.access));
        separator = ", ";
    }
    text += "]}";
}

void appendResourceJson(std::string& text, const CompiledResource& resource) {
    const auto number = [](uint32_t value) {
        return value == kNoIndex ? std::string("null") : std::to_string(value);
    };
    append(
        text,
        "    {{\"name\": {}, \"kind\": \"{}\", \"description\": {}, \"bytes\": {}, \"origin\": \"{}\"",
        quoted(resource.name), resource.isBuffer ? "buffer" : "texture", quoted(describe(resource)),
        resource.bytes, originName(resource.origin));
    append(text, ", \"first_pass\": {}, \"last_pass\": {}, \"slot\": {}, \"output\": {}}}",
           number(resource.firstPass), number(resource.lastPass), number(resource.slot),
           resource.isOutput);
}

std::string dumpJson(const CompiledGraph& graph) {
    std::string text = "{\n  \"passes\": [\n";
    for (size_t i = 0; i < graph.passes.size(); ++i) {
        appendPassJson(text, graph, graph.passes[i]);
        text += i + 1 < graph.passes.size() ? ",\n" : "\n";
    }
    text += "  ],\n  \"resources\": [\n";
    for (size_t i = 1; i < graph.resources.size(); ++i) {
        appendResourceJson(text, graph.resources[i]);
        text += i + 1 < graph.resources.size() ? ",\n" : "\n";
    }
    append(text, "  ],\n  \"pooled_bytes\": {}, \"unpooled_bytes\": {},\n  \"errors\": [",
           graph.pooledBytes(), graph.unpooledBytes());
    for (size_t i = 0; i < graph.errors.size(); ++i)
        append(text, "{}{}", i == 0 ? "" : ", ", quoted(graph.errors[i]));
    return text + "]\n}\n";
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
