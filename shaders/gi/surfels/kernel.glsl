// Light that a surfel sends through a point, over its radiance.
#ifndef TYNDALL_GI_SURFELS_KERNEL
#define TYNDALL_GI_SURFELS_KERNEL

/// From afar the surfel's solid angle, A cos/d². Near by, a disk whose light comes from as far behind it as makes a plane full of surfels send 2π to every point before it,
/// however near; on its axis that is π r²/(d² + r²), the disk's closed form on a facing receiver. `height` above the disk's plane, `squared` distance from its middle.
float kernel(float area, float height, float squared) {
    float r2 = area * (1.0 / 3.14159265358979);
    float sum = squared + r2;
    return area * sqrt(height * height + r2) / (sum * sqrt(sum));
}

#endif
