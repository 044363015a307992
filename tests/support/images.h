#pragma once
// Small pictures that tests are made of.

#include "core/image.h"

namespace tyndall::test {

/// `width`×`height` pixels of one colour, three channels.
[[nodiscard]] inline Image uniformImage(int width, int height, float r, float g, float b) {
    Image image(width, height, 3);
    for (size_t i = 0; i < image.pixels.size(); i += 3) {
        image.pixels[i] = r;
        image.pixels[i + 1] = g;
        image.pixels[i + 2] = b;
    }
    return image;
}

} // namespace tyndall::test
