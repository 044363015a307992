#include "validation/measure.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

namespace tyndall::validation {
namespace {

using tracing::PathCounts;
using tracing::Sampler;
using reference::VolumePathTracer;

constexpr uint64_t kPilotSamples = 64; // a batch
constexpr uint64_t kMostSamples = uint64_t(1) << 30;

struct Sums {
    double sum = 0, squares = 0;
};

class Run {
public:
    Run(const Probe& probe, uint64_t seed) : probe_(probe), seed_(seed) {}

    /// One mean for each batch.
    std::vector<double> batches(uint64_t samples) {
        const uint64_t chunk = std::clamp<uint64_t>(samples / 16, 16, 4096);
        const uint64_t chunks = (samples + chunk - 1) / chunk;
        std::vector<Sums> sums(size_t(chunks) * kBatches);
        tbb::parallel_for(
            tbb::blocked_range<size_t>(0, sums.size(), 1),
            [&](const tbb::blocked_range<size_t>& range) {
                for (size_t i = range.begin(); i != range.end(); ++i) {
                    const uint64_t first = (i % chunks) * chunk;
                    sums[i] = part(i / chunks, first, std::min(chunk, samples - first));
                }
            },
            tbb::simple_partitioner());
        std::vector<double> means;
        total_ = {};
        for (size_t batch = 0; batch < kBatches; ++batch) {
            Sums all;
            for (size_t i = 0; i < chunks; ++i) {
                all.sum += sums[batch * chunks + i].sum;
                all.squares += sums[batch * chunks + i].squares;
            }
            means.push_back(all.sum / double(samples));
            total_.sum += all.sum;
            total_.squares += all.squares;
        }
        return means;
    }
    [[nodiscard]] PathCounts counts() {
        PathCounts all;
        for (const auto& tracers : tracers_)
            for (const VolumePathTracer& tracer : tracers) all.add(tracer.counts());
        return all;
    }
    [[nodiscard]] Sums total() const { return total_; }

private:
    Sums part(uint64_t batch, uint64_t first, uint64_t count) {
        std::vector<VolumePathTracer>& tracers = tracers_.local();
        if (tracers.empty() && probe_.stage)
            for (const reference::PathSettings& settings : probe_.settings)
                tracers.emplace_back(probe_.stage->traced, settings);
        Sums sums;
        for (uint64_t i = first; i < first + count; ++i) {
            Sampler sampler(seed_, batch, uint32_t(i));
            const double value = probe_.sample(tracers, sampler);
            sums.sum += value;
            sums.squares += value * value;
        }
        return sums;
    }
    const Probe& probe_;
    uint64_t seed_;
    Sums total_;
    tbb::enumerable_thread_specific<std::vector<VolumePathTracer>> tracers_;
};

/// d value / d mean, for the error.
double slopeOf(const Probe& probe, double mean, double step) {
    if (!probe.value || !(step > 0)) return 1;
    return (probe.value(mean + step) - probe.value(mean - step)) / (2 * step);
}

uint64_t samplesFor(const Probe& probe, const Effort& effort, uint64_t seed) {
    Run pilot(probe, tracing::mixBits(seed ^ 0x70696c6f74ull));
    pilot.batches(kPilotSamples);
    const double n = double(kPilotSamples * kBatches), mean = pilot.total().sum / n;
    const double deviation = std::sqrt(std::max(0.0, pilot.total().squares / n - mean * mean));
    const double slope = std::abs(slopeOf(probe, mean, deviation / std::sqrt(n)));
    const PathCounts counts = pilot.counts();
    const double work = probe.segmentsPerSample > 0
                            ? probe.segmentsPerSample
                            : double(counts.segments + counts.shadowRays) / n;
    const double affordable = effort.segments / std::max(work, 1.0) / kBatches;
    double wanted = affordable;
    // A pilot that saw nothing at all says nothing about the spread.
    if (deviation > 0 && effort.targetError > 0) {
        const double ratio = deviation * slope / effort.targetError;
        wanted = ratio * ratio / kBatches;
    }
    const double count = std::min(wanted, affordable);
    return std::clamp(uint64_t(std::min(count, 1e18)), effort.minimumSamples, kMostSamples);
}

} // namespace

std::shared_ptr<const Stage> Stage::make(Scene scene) {
    auto stage = std::make_shared<Stage>();
    stage->scene = std::move(scene);
    auto traced = tracing::TracerScene::build(stage->scene, dvec3(0), 1);
    if (!traced.ok()) throw std::runtime_error(traced.message());
    stage->traced = std::move(*traced);
    return stage;
}

MeanAndError meanAndError(const std::vector<double>& values) {
    const double n = double(values.size());
    MeanAndError result;
    for (const double value : values) result.mean += value / n;
    double squares = 0;
    for (const double value : values) squares += (value - result.mean) * (value - result.mean);
    result.error = values.size() > 1 ? std::sqrt(squares / (n - 1) / n) : 0;
    return result;
}

Estimate measure(const Probe& probe, const Effort& effort, uint64_t seed) {
    const uint64_t samples = samplesFor(probe, effort, seed);
    Run run(probe, seed);
    const MeanAndError mean = meanAndError(run.batches(samples));
    Estimate estimate;
    estimate.value = probe.value ? probe.value(mean.mean) : mean.mean;
    estimate.error = mean.error * std::abs(slopeOf(probe, mean.mean, mean.error));
    estimate.samples = samples * kBatches;
    estimate.counts = run.counts();
    return estimate;
}

} // namespace tyndall::validation
