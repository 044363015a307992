#include "media/reader/voxel_sink.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <sys/socket.h>
#include <unistd.h>

namespace tyndall::reader {

namespace {

void sendAll(int socket, const void* data, size_t bytes) {
    const char* next = static_cast<const char*>(data);
    while (bytes > 0) {
        const ssize_t sent = ::send(socket, next, bytes, MSG_NOSIGNAL);
        if (sent < 0 && errno == EINTR) continue;
        if (sent <= 0) _exit(0); // nobody listens any more
        next += sent;
        bytes -= size_t(sent);
    }
}

} // namespace

void VoxelSink::send(stream::MessageType type, const void* head, size_t headBytes,
                     std::string_view text) {
    const stream::MessageHeader header{stream::kMagic, type, uint32_t(headBytes + text.size())};
    sendAll(socket_, &header, sizeof header);
    sendAll(socket_, head, headBytes);
    sendAll(socket_, text.data(), text.size());
}

void VoxelSink::block(const std::array<int32_t, 3>& origin, const float* valuesZFastest) {
    if (std::all_of(valuesZFastest, valuesZFastest + 512, [](float value) { return value == 0; }))
        return;
    stream::BlockRecord& record = blocks_.emplace_back();
    std::copy(origin.begin(), origin.end(), record.origin);
    for (int z = 0; z < 8; ++z)
        for (int y = 0; y < 8; ++y)
            for (int x = 0; x < 8; ++x)
                record.values[z * 64 + y * 8 + x] = valuesZFastest[x * 64 + y * 8 + z];
    if (blocks_.size() == stream::kBlocksPerMessage) flushBlocks();
}

void VoxelSink::tile(const std::array<int32_t, 3>& origin, int32_t size, float value) {
    tiles_.push_back({{origin[0], origin[1], origin[2]}, size, value});
    if (tiles_.size() == stream::kTilesPerMessage) flushTiles();
}

void VoxelSink::flushBlocks() {
    if (!blocks_.empty())
        send(stream::MessageType::Blocks, blocks_.data(),
             blocks_.size() * sizeof(stream::BlockRecord));
    blocks_.clear();
}

void VoxelSink::flushTiles() {
    if (!tiles_.empty())
        send(stream::MessageType::Tiles, tiles_.data(), tiles_.size() * sizeof(stream::TileRecord));
    tiles_.clear();
}

void VoxelSink::endGrid() {
    flushBlocks();
    flushTiles();
    send(stream::MessageType::GridEnd, nullptr, 0);
}

} // namespace tyndall::reader
