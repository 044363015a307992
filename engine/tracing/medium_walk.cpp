// The pieces of a medium along a ray, within which its density is bounded.

#include <algorithm>
#include <cmath>

#include "tracing/media_field.h"

namespace tyndall::tracing {
namespace {

/// Height fog is cut where its density has fallen by this factor: tentative collisions are real nearly nine times in ten …
const double kHeightFall = std::sqrt(0.5);
/// … but not more finely than into this optical depth: where collisions are rare, so are those that are not real.
constexpr double kThinPiece = 0.1;
constexpr double kHighest = kHighestFog; // in scale heights

} // namespace

MediumWalk::MediumWalk(const MediumSource& medium, const Ray& ray, Interval interval)
    : medium_(&medium), begin_(interval.begin), end_(interval.end), stop_(interval.end) {
    if (interval.empty()) {
        done_ = true;
        return;
    }
    if (medium.isGrid()) {
        origin_ = medium.localPoint(ray.origin);
        direction_ = dmat3(medium.localFromRay_) * ray.direction;
        for (int axis = 0; axis < 3; ++axis) perUnit_[axis] = 1 / direction_[axis];
        startGrid();
    } else if (medium.isHeight()) {
        height_ = glm::dot(medium.up_, ray.origin) - medium.ground_;
        slope_ = glm::dot(medium.up_, ray.direction);
        enterHeight();
    }
}

void MediumWalk::next() {
    if (end_ >= stop_) {
        done_ = true;
        return;
    }
    begin_ = end_;
    if (medium_->isHeight()) {
        enterHeight();
        return;
    }
    // The axis whose plane was reached first.
    const int axis = crossing_.x <= crossing_.y ? (crossing_.x <= crossing_.z ? 0 : 2)
                                                : (crossing_.y <= crossing_.z ? 1 : 2);
    brick_[axis] += direction_[axis] > 0 ? 1 : -1;
    if (brick_[axis] < 0 || brick_[axis] >= medium_->grid_->brickCount[axis]) {
        done_ = true;
        return;
    }
    enterBrick();
}

void MediumWalk::startGrid() {
    const dvec3 p = origin_ + begin_ * direction_ - dvec3(medium_->grid_->origin);
    brick_ = glm::clamp(ivec3(glm::floor(p / double(kBrickCells))), ivec3(0),
                        medium_->grid_->brickCount - 1);
    enterBrick();
}

void MediumWalk::enterBrick() {
    const BrickGrid& grid = *medium_->grid_;
    for (int axis = 0; axis < 3; ++axis) {
        const int plane =
            grid.origin[axis] + kBrickCells * (brick_[axis] + (direction_[axis] > 0 ? 1 : 0));
        crossing_[axis] =
            direction_[axis] == 0 ? kInfinity : (double(plane) - origin_[axis]) * perUnit_[axis];
    }
    end_ = std::clamp(std::min({crossing_.x, crossing_.y, crossing_.z}), begin_, stop_);
    const BrickBounds& bounds =
        medium_->bricks_[(size_t(brick_.z) * size_t(grid.brickCount.y) + size_t(brick_.y)) *
                             size_t(grid.brickCount.x) +
                         size_t(brick_.x)];
    minimum_ = double(bounds.minimum);
    maximum_ = double(bounds.maximum);
    mean_ = double(bounds.mean);
}

void MediumWalk::enterHeight() {
    const double scale = medium_->scaleHeight_;
    const double low = height_ + slope_ * begin_;
    const double dense = low > 0 ? (low < kHighest * scale ? std::exp(-low / scale) : 0.0) : 1.0;
    const double strongest = maximumOf(medium_->extinction);
    const double step =
        std::max(-scale * std::log(kHeightFall),
                 kThinPiece * std::abs(slope_) / std::max(dense * strongest, 1e-300));
    double next = kInfinity; // the height at which the piece ends
    if (slope_ > 0) next = low < 0 ? 0 : (dense > 0 ? low + step : kInfinity);
    if (slope_ < 0)
        next = dense == 0 ? kHighest * scale : (low > 0 ? std::max(0.0, low - step) : -kInfinity);
    end_ = stop_;
    if (std::isfinite(next) && slope_ != 0)
        end_ = std::clamp((next - height_) / slope_, std::nextafter(begin_, kInfinity), stop_);
    const double high = std::isinf(end_) && slope_ < 0 ? -kInfinity : height_ + slope_ * end_;
    double other = dense;
    if (slope_ != 0)
        other = high > 0 ? (high < kHighest * scale ? std::exp(-high / scale) : 0.0) : 1.0;
    minimum_ = std::min(dense, other);
    maximum_ = std::max(dense, other);
    // The mean of an exponential between its ends.
    mean_ = maximum_ - minimum_ > 1e-3 * maximum_ && minimum_ > 0
                ? (maximum_ - minimum_) / std::log(maximum_ / minimum_)
                : 0.5 * (minimum_ + maximum_);
}

double MediumWalk::density(double t) const {
    if (minimum_ == maximum_) return minimum_;
    if (medium_->isHeight()) {
        const double h = height_ + slope_ * t;
        return std::exp(-std::max(0.0, h) / medium_->scaleHeight_);
    }
    const dvec3 index = origin_ + t * direction_;
    const ivec3 first = brick_ * kBrickCells,
                cell(glm::floor(index - dvec3(medium_->grid_->origin)));
    return medium_->cellDensity(glm::clamp(cell, first, first + kBrickCells - 1), index);
}

} // namespace tyndall::tracing
