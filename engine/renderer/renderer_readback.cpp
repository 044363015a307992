#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/check.h"
#include "renderer/renderer_impl.h"

namespace tyndall {
namespace {

Image withoutAlpha(const Image& image) {
    Image result(image.width, image.height, 3);
    for (size_t i = 0; i < size_t(image.width) * size_t(image.height); ++i)
        std::memcpy(&result.pixels[i * 3], &image.pixels[i * size_t(image.channels)],
                    3 * sizeof(float));
    return result;
}

/// The inverse of octahedralEncodeUnorm in shaders/common/octahedral.glsl.
vec3 octahedralDecodeUnorm(vec2 unorm) {
    const vec2 square = glm::clamp(unorm * (65535.0f / 65534.0f) * 2.0f - 1.0f, vec2(-1), vec2(1));
    vec3 p(square, 1.0f - std::abs(square.x) - std::abs(square.y));
    if (p.z < 0)
        p = vec3((1.0f - std::abs(square.y)) * (square.x >= 0 ? 1.0f : -1.0f),
                 (1.0f - std::abs(square.x)) * (square.y >= 0 ? 1.0f : -1.0f), p.z);
    return glm::normalize(p);
}

/// Metres along the ray of each pixel; 0 where there is no surface.
Image distances(const Image& depth, const gpu::ViewData& view) {
    Image result(depth.width, depth.height, 1);
    const dmat4 renderFromClip(view.renderFromClip);
    for (int y = 0; y < depth.height; ++y)
        for (int x = 0; x < depth.width; ++x) {
            const double z = double(depth.at(x, y)[0]);
            if (z <= 0) continue;
            const dvec2 clip((x + 0.5) / depth.width * 2 - 1, 1 - (y + 0.5) / depth.height * 2);
            const dvec4 point = renderFromClip * dvec4(clip, z, 1),
                        start = renderFromClip * dvec4(clip, 1, 1);
            const bool parallel = view.flags & gpu::kViewOrthographic;
            const dvec3 from = parallel ? dvec3(start) / start.w : dvec3(view.cameraPosition);
            result.at(x, y)[0] = float(glm::length(dvec3(point) / point.w - from));
        }
    return result;
}

Image normals(const Image& packed, const Image& depth) {
    Image result(packed.width, packed.height, 3);
    for (int y = 0; y < packed.height; ++y)
        for (int x = 0; x < packed.width; ++x) {
            if (depth.at(x, y)[0] <= 0) continue;
            const vec3 normal = octahedralDecodeUnorm({packed.at(x, y)[0], packed.at(x, y)[1]});
            std::memcpy(result.at(x, y), &normal, sizeof normal);
        }
    return result;
}

} // namespace

Image Renderer::readBeauty() {
    return withoutAlpha(impl_->executor.readImage(impl_->images.beauty));
}

std::vector<TermImage> Renderer::readTerms() {
    std::vector<TermImage> result;
    for (uint32_t i = 0; i < impl_->images.terms.count; ++i) {
        const TermImageHandle& handle = impl_->images.terms.images[i];
        Image image = withoutAlpha(impl_->executor.readImage(handle.image));
        // Techniques that share terms by kind of medium have an image each.
        const auto same = std::find_if(result.begin(), result.end(), [&](const TermImage& other) {
            return other.terms == handle.terms;
        });
        if (same != result.end()) {
            for (size_t k = 0; k < image.pixels.size(); ++k)
                same->image.pixels[k] += image.pixels[k];
            continue;
        }
        std::string name = termNames(handle.terms);
        for (char& c : name)
            if (c == ',') c = '+';
        result.push_back({handle.terms, name, std::move(image)});
    }
    return result;
}

std::vector<InvalidTerms> Renderer::readInvalidTerms() {
    std::vector<InvalidTerms> result;
    const TermImages& terms = impl_->images.terms;
    if (terms.count == 0) return result;
    const std::vector<std::byte> bytes = impl_->executor.readBuffer(impl_->images.firstInvalid);
    for (uint32_t i = 0; i < terms.count; ++i) {
        uint32_t kept = 0; // ~frame, so that the first one is the largest number
        CHECK((i + 1) * sizeof kept <= bytes.size());
        std::memcpy(&kept, &bytes[i * sizeof kept], sizeof kept);
        if (kept != 0) result.push_back({terms.images[i].terms, terms.images[i].owner, ~kept});
    }
    std::stable_sort(result.begin(), result.end(),
                     [](const auto& a, const auto& b) { return a.firstFrame < b.firstFrame; });
    return result;
}

std::map<std::string, double> Renderer::readStatistics() {
    std::map<std::string, double> result;
    for (const StatisticsBuffer& statistics : impl_->images.statistics) {
        const std::vector<std::byte> bytes = impl_->executor.readBuffer(statistics.values);
        for (const auto& [name, element] : statistics.elements) {
            float value = 0;
            CHECK((element + 1) * sizeof value <= bytes.size());
            std::memcpy(&value, &bytes[element * sizeof value], sizeof value);
            result[name] = double(value);
        }
    }
    return result;
}

std::vector<uint8_t> Renderer::readDisplay() {
    const Image image =
        impl_->executor.readImage(impl_->inspected ? impl_->inspected : impl_->images.display.image);
    std::vector<uint8_t> bytes(size_t(image.width) * size_t(image.height) * 3);
    for (size_t i = 0; i < bytes.size(); ++i)
        bytes[i] =
            uint8_t(std::lround(image.pixels[i / 3 * size_t(image.channels) + i % 3] * 255.0f));
    return bytes;
}

uint32_t Renderer::displayTexture() const {
    return impl_->executor.textureName(impl_->inspected ? impl_->inspected : impl_->images.display.image);
}

Result<Image> Renderer::readAov(std::string_view name) {
    const FrameImages& images = impl_->images;
    if (name == "depth")
        return distances(impl_->executor.readImage(images.gbuffer.depth), impl_->order.view.data);
    if (name == "normal")
        return normals(impl_->executor.readImage(images.gbuffer.normal),
                       impl_->executor.readImage(images.gbuffer.depth));
    if (name == "albedo") return withoutAlpha(impl_->executor.readImage(images.gbuffer.base));
    if (name == "transmittance") {
        if (images.transmittance)
            return withoutAlpha(impl_->executor.readImage(images.transmittance));
        Image clear(impl_->order.view.width, impl_->order.view.height, 3);
        std::fill(clear.pixels.begin(), clear.pixels.end(), 1.0f);
        return clear;
    }
    return Error{"layer '" + std::string(name) +
                 "' is unknown: there are depth, normal, albedo, transmittance and terms"};
}

} // namespace tyndall
