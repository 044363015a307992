#pragma once
// Long work as whoever waits for it sees it: how far it is, and how to end it. A job knows neither terminal nor signals nor window:
// a program shows its progress on stderr, the editor in a pane.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>

namespace tyndall {

/// How far a job is.
struct JobProgress {
    uint32_t phase =
        0; // counts the phases that began and ended, so that a new one is told from the one before
    std::string label;   // of the phase: "loading smoke.scene.json"; empty between phases
    double fraction = 0; // of the phase, 0 to 1
    std::string
        sentence; // what is being done right now: "rendering: 12 samples a pixel"; empty: the label says it all
};

/// Shared by a job and by who waits for it. All functions may be called from any thread.
class JobControl {
public:
    /// Hears each change of progress, one at a time, on the thread that works.
    using Listener = std::function<void(const JobProgress&)>;
    /// Asked by the work, from any of its threads, whether it shall end.
    using StopRequest = std::function<bool()>;

    JobControl() = default;
    explicit JobControl(Listener listener, StopRequest stop = {})
        : listener_(std::move(listener)), stop_(std::move(stop)) {}
    JobControl(const JobControl&) = delete;
    JobControl& operator=(const JobControl&) = delete;

    /// The work ends at its next safe place, with nothing half written. There is no way back.
    void cancel() { cancelled_ = true; }
    [[nodiscard]] bool cancelled() const { return cancelled_ || (stop_ && stop_()); }
    [[nodiscard]] JobProgress progress() const;

private:
    friend class JobPhase;
    template <typename Change> void change(const Change& change);

    std::atomic<bool> cancelled_ = false;
    mutable std::mutex mutex_; // of progress_
    JobProgress progress_;
    std::mutex listening_; // held while the listener hears, so that it may ask for progress()
    Listener listener_;
    StopRequest stop_;
};

/// A part of a job with a fraction of its own, from construction to destruction.
class JobPhase {
public:
    JobPhase(JobControl& control, std::string label);
    ~JobPhase();
    JobPhase(const JobPhase&) = delete;
    JobPhase& operator=(const JobPhase&) = delete;

    /// `fraction` is clamped to 0..1. An empty sentence leaves the label to speak.
    void update(double fraction, std::string sentence = {});

private:
    JobControl& control_;
};

/// Work on a thread of its own. Destruction cancels it and waits for its end.
template <typename T> class Job {
public:
    explicit Job(std::function<T(JobControl&)> work)
        : control_(std::make_unique<JobControl>()),
          result_(
              std::async(std::launch::async, [control = control_.get(), work = std::move(work)] {
                  return work(*control);
              })) {}
    Job(Job&&) noexcept = default;
    ~Job() {
        if (control_) control_->cancel(); // the future's destructor waits
    }

    [[nodiscard]] JobControl& control() { return *control_; }
    [[nodiscard]] bool finished() const {
        return result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    }
    /// Waits for the end. What the work throws is thrown here. Once only.
    [[nodiscard]] T take() { return result_.get(); }

private:
    std::unique_ptr<JobControl> control_;
    std::future<T> result_;
};

} // namespace tyndall
