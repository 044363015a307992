#pragma once
// How a quantity is measured with a path tracer, and how well: independent batches, their mean, and its standard error.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "reference/volume_path_tracer.h"

namespace tyndall::validation {

/// Batches share no random numbers: the spread of their means is the error, low-discrepancy points or not.
inline constexpr int kBatches = 20;
/// Student's t with kBatches - 1 degrees of freedom exceeds this with a chance of 0.24 %.
inline constexpr double kLargestT = 3.5;

/// A scene made ready, with all that must outlive it.
struct Stage {
    Scene scene;
    tracing::TracerScene traced;
    /// Throws std::runtime_error where the scene cannot be built.
    static std::shared_ptr<const Stage> make(Scene scene);
};

/// A way to estimate one number: the mean over random samples, put through `value`.
struct Probe {
    std::shared_ptr<const Stage> stage;
    std::vector<reference::PathSettings> settings{{}}; // of the tracers handed to `sample`
    std::function<double(std::vector<reference::VolumePathTracer>&, tracing::Sampler&)> sample;
    std::function<double(double)> value; // of the mean; empty: the mean itself
    double bias = 0;              // of `value`, relative: what the recipe itself may be off by
    double effort = 1;            // how many times the effort of others it deserves
    double segmentsPerSample = 0; // where `sample` traces without the tracers
};

struct Effort {
    double targetError = 0;       // standard error that will do
    double segments = 1e6;        // path segments and shadow rays that it may take
    uint64_t minimumSamples = 64; // in a batch
};

struct Estimate {
    double value = 0;
    double error = 0; // standard error, kBatches - 1 degrees of freedom
    uint64_t samples = 0;
    tracing::PathCounts counts;
};

/// The number of samples follows from a pilot with random numbers of its own, and from no clock: the same seed gives the same
/// estimate, bit for bit, on any machine.
Estimate measure(const Probe& probe, const Effort& effort, uint64_t seed);

/// Mean and standard error of independent values.
struct MeanAndError {
    double mean = 0, error = 0;
};
MeanAndError meanAndError(const std::vector<double>& values);

} // namespace tyndall::validation
