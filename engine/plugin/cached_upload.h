#pragma once
// Processor data in a buffer of the frame, uploaded only when they have changed.

#include <algorithm>
#include <bit>
#include <ranges>

#include "framegraph/frame_graph.h"

namespace tyndall {

/// Adds a pass and a buffer of these names (literals; they may be the same). `data` must stay until the frame has been executed; `key` (plugin/cache_key.h)
/// is of its content. The buffer's size is a power of two, so that few are ever made; what is behind the data is undefined. Empty data: zeros.
inline fg::BufferHandle addCachedUpload(fg::FrameGraph& graph, const char* pass, const char* buffer,
                                        const void* data, size_t bytes, uint64_t key) {
    struct Upload {
        fg::BufferHandle buffer;
        const void* data;
        size_t bytes;
    };
    return graph
        .addPass<Upload>(
            pass,
            [&](fg::Builder& builder, Upload& upload) {
                constexpr size_t kLeast = 256;
                upload.buffer =
                    builder.create(buffer, fg::BufferDesc{std::bit_ceil(std::max(bytes, kLeast))},
                                   fg::Access::TransferWrite);
                upload.data = data;
                upload.bytes = bytes;
                builder.cacheBy(key);
            },
            [](const Upload& upload, fg::PassContext& context) {
                if (upload.bytes > 0)
                    context.upload(upload.buffer, 0, upload.data, upload.bytes);
                else
                    context.clearBuffer(upload.buffer, 0);
            })
        .buffer;
}

/// The same of a vector or a span, in a buffer of the pass's name.
template <std::ranges::contiguous_range Values>
fg::BufferHandle addCachedUpload(fg::FrameGraph& graph, const char* name, const Values& values,
                                 uint64_t key) {
    return addCachedUpload(graph, name, name, std::ranges::data(values),
                           std::ranges::size(values) * sizeof(*std::ranges::data(values)), key);
}

} // namespace tyndall
