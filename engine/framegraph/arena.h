#pragma once
// Memory for one frame: pass data and names. Chunks are kept from frame to frame, so that a graph that does not
// grow stops allocating.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>
#include <vector>

namespace tyndall::fg {

class Arena {
public:
    void* allocate(size_t bytes, size_t alignment) {
        if (chunk_ < chunks_.size()) {
            if (void* place = fit(chunks_[chunk_], bytes, alignment)) return place;
            ++chunk_;
            used_ = 0;
        }
        while (chunk_ <
               chunks_.size()) { // a chunk of an earlier frame may be too small for this request
            if (void* place = fit(chunks_[chunk_], bytes, alignment)) return place;
            ++chunk_;
        }
        const size_t size = std::max(kChunkBytes, bytes + alignment);
        chunks_.push_back({std::make_unique<std::byte[]>(size), size});
        used_ = 0;
        return fit(chunks_.back(), bytes, alignment);
    }

    /// A copy that ends with a zero byte, for those who need a C string.
    std::string_view copy(std::string_view text) { return concatenate(text, {}); }
    std::string_view concatenate(std::string_view first, std::string_view second) {
        const size_t size = first.size() + second.size();
        char* place = static_cast<char*>(allocate(size + 1, 1));
        std::copy(first.begin(), first.end(), place);
        std::copy(second.begin(), second.end(), place + first.size());
        place[size] = '\0';
        return {place, size};
    }

    /// Everything allocated before is gone.
    void clear() { chunk_ = 0, used_ = 0; }

private:
    static constexpr size_t kChunkBytes = 64 * 1024;
    struct Chunk {
        std::unique_ptr<std::byte[]> bytes;
        size_t size;
    };

    void* fit(const Chunk& chunk, size_t bytes, size_t alignment) {
        void* place = chunk.bytes.get() + used_;
        size_t space = chunk.size - used_;
        if (!std::align(alignment, bytes, place, space)) return nullptr;
        used_ = chunk.size - space + bytes;
        return place;
    }

    std::vector<Chunk> chunks_;
    size_t chunk_ = 0, used_ = 0;
};

} // namespace tyndall::fg
