// tyndall-grid-reader: reads one OpenVDB or NanoVDB file for the importer (media/grid_import.h) and streams its voxels
// through the socket that is its standard input. It exists so that a damaged file ends this process and no other.

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <new>
#include <string>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include "media/reader/voxel_sink.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define TYNDALL_SANITIZED 1 // the shadow memory alone is larger than any sensible limit
#else
#define TYNDALL_SANITIZED 0
#endif

namespace {

using namespace tyndall;
using namespace tyndall::reader;

constexpr int kSocket = STDIN_FILENO;

void setLimit(decltype(RLIMIT_CORE) resource, uint64_t value) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0) return;
    limit.rlim_cur =
        limit.rlim_max == RLIM_INFINITY ? rlim_t(value) : std::min(rlim_t(value), limit.rlim_max);
    setrlimit(resource, &limit);
}

bool receive(void* data, size_t bytes) {
    char* next = static_cast<char*>(data);
    while (bytes > 0) {
        const ssize_t got = ::recv(kSocket, next, bytes, 0);
        if (got < 0 && errno == EINTR) continue;
        if (got <= 0) return false;
        next += got;
        bytes -= size_t(got);
    }
    return true;
}

void sendGrid(VoxelSink& sink, GridDescription grid) {
    const auto shorten = [](std::string& text) {
        if (text.size() > stream::kMaximumTextBytes) text.resize(stream::kMaximumTextBytes);
        return uint32_t(text.size());
    };
    grid.record.nameBytes = shorten(grid.name);
    grid.record.typeBytes = shorten(grid.type);
    grid.record.classBytes = shorten(grid.gridClass);
    sink.send(stream::MessageType::Grid, &grid.record, sizeof grid.record,
              grid.name + grid.type + grid.gridClass);
}

std::unique_ptr<GridSource> openSource(const std::string& path) {
    char magic[8] = {};
    std::ifstream(path, std::ios::binary).read(magic, sizeof magic);
    if (std::memcmp(magic, "NanoVDB", 7) == 0) return openNanoVdb(path);
    if (std::memcmp(magic, " BDV", 4) == 0) return openOpenVdb(path);
    return nullptr;
}

void serve(const std::string& path, VoxelSink& sink) {
    const std::unique_ptr<GridSource> source = openSource(path);
    if (!source) throw std::runtime_error("it begins like neither an OpenVDB nor a NanoVDB file");
    sink.send(stream::MessageType::Hello, &stream::kStreamVersion, sizeof stream::kStreamVersion,
              source->format());
    std::vector<GridDescription> grids = source->list();
    if (grids.size() > stream::kMaximumGrids)
        throw std::runtime_error("it claims to hold " + std::to_string(grids.size()) + " grids");
    for (const GridDescription& grid : grids) sendGrid(sink, grid);
    sink.send(stream::MessageType::ListEnd, nullptr, 0);

    for (stream::Command command; receive(&command, sizeof command);) {
        if (command.magic != stream::kMagic || command.grid >= grids.size()) _exit(2);
        if (command.type == stream::CommandType::Measure) {
            sendGrid(sink, source->measure(command.grid));
        } else {
            source->read(command.grid, sink);
            sink.endGrid();
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 1 + stream::kReaderArguments) {
        std::fputs(
            "tyndall-grid-reader is started by tyndall's own programs; it is not of use alone.\n",
            stderr);
        return 2;
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    setLimit(RLIMIT_CORE, 0);
    if (const uint64_t bytes = std::strtoull(argv[2], nullptr, 10); bytes > 0 && !TYNDALL_SANITIZED)
        setLimit(RLIMIT_AS, bytes);
    if (const uint64_t seconds = std::strtoull(argv[3], nullptr, 10); seconds > 0)
        setLimit(RLIMIT_CPU, seconds);

    VoxelSink sink(kSocket);
    const auto fail = [&](std::string reason) {
        if (reason.size() > stream::kMaximumTextBytes) reason.resize(stream::kMaximumTextBytes);
        sink.send(stream::MessageType::Failure, nullptr, 0, reason);
    };
    try {
        serve(argv[1], sink);
    } catch (const std::bad_alloc&) {
        fail("it needs more memory than allowed");
    } catch (const std::exception& failure) {
        fail(failure.what());
    } catch (...) {
        fail("the reading library gave up");
    }
    _exit(0); // nothing to save, and a damaged tree need not survive its destructor
}
