// Light of virtual point lights that media scatter along a ray. Each segment of the ray gathers, at one point, one interleaved subset of the walks; the
// next segment gathers the next subset (Engelhardt, Novák and Dachsbacher 2010, section 4.2).
#include "gi/vpl/compensation.glsl"

/// A direction from the mixture of phase functions that scatter the segment's light: where light that goes against `direction` came from.
/// `weight`: of the function over the density.
vec3 phaseDirection(Segment s, vec3 direction, vec3 u, out float weight) {
    uint chosen = 0u;
#if MARCH_PHASE_GROUPS > 1
    float total = 0.0;
    for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g) total += meanOf(s.scattering[g]);
    float target = u.z * total;
    for (uint g = 0u; g < min(mediaHeader.phaseGroupCount, uint(MARCH_PHASE_GROUPS)); ++g) {
        chosen = g;
        if (target < meanOf(s.scattering[g])) break;
        target -= meanOf(s.scattering[g]);
    }
#endif
    float cosine = samplePhaseFunction(uint(mediaHeader.phases[chosen].x), mediaHeader.phases[chosen].y, u.x, weight);
    float sine = sqrt(max(1.0 - cosine * cosine, 0.0));
    float angle = 2.0 * kPi * u.y;
    return normalize(frameAround(direction) * vec3(sine * cos(angle), sine * sin(angle), cosine));
}

/// 1/b of a point in a medium: at most the free path there, or clamping would remove most of the light and compensation would need many
/// steps. As the processor has it (BiasCompensation::clampedOnGpu).
float localClampSquared(vec3 position) {
    if (vpl.upToFreePath == 0u) return vplClampScale(position) * vpl.clampSquared;
    vec3 extinction = vec3(0.0);
    for (uint m = 0u; m < mediumCount(); ++m) extinction += media[m].extinction.rgb * mediumDensity(m, position);
    float freePath = 1.0 / max(maximumOf(extinction), 1e-15);
    return min(vplClampScale(position) * vpl.clampSquared, freePath * freePath);
}

vec3 scatteringOf(Segment s) {
    vec3 sum = vec3(0.0);
    for (int g = 0; g < MARCH_PHASE_GROUPS; ++g) sum += s.scattering[g];
    return sum;
}

/// Clamped light compensated as if light were even: with F the part that clamping removes of
/// light that is scattered here, S = S_clamped + albedo F (S_direct + S).
vec3 evenCompensation(vec3 clamped, float clampSquared, Segment s, Ray ray, vec3 u, uint number) {
    float reach = sqrt(clampSquared);
    vec3 albedo = min(scatteringOf(s) / max(s.depth, vec3(1e-30)), vec3(1.0));
    vec3 again = albedo * clampLoss(s.depth * (reach / s.size));
    Segment here = pointSegment(ray, 0.0, reach);
    vec3 direct = s.size * segmentInScatter(ray, here, vpl.lightsOfScene, u, number);
    return (clamped + again * direct) / max(1.0 - again, vec3(1e-3));
}

/// Light that a segment scatters at `position` against `direction`: of one subset of the walks, and compensation from another subset.
/// A loop: compilers inline all functions, and walksInMedium() must be inlined only once.
vec3 gatherAt(uint number, uint other, vec3 position, vec3 direction, Segment s, vec4 u) {
    float clampSquared = localClampSquared(position);
    vec3 light = vec3(0.0);
    vec3 weight = vec3(1.0);
    Ray back = Ray(position, direction);
    vec3 at = position;
    Segment here = s;
    float stepClampSquared = clampSquared;
    for (uint step = 0u;; ++step) {
        uint terms = step == 0u ? vpl.mediaTerms : vplTermsOneStepOn(vpl.mediaTerms);
        vec3 gathered = walksInMedium(step == 0u ? number : other, at, back.direction, here, stepClampSquared, terms);
#if COMPENSATION == 2
        if (step > 0u && (vpl.mediaTerms & (1u << kVplOfMedia)) != 0u) gathered += segmentInScatter(back, here, vpl.lightsOfScene, u.xyz, number);
        light += weight * gathered;
        if (step == vpl.compensation / kVplTraced) break;
        float overDensity;
        back.direction = phaseDirection(s, direction, u.xyz, overDensity);
        float reach = sqrt(clampSquared);
        float t;
        if (!drawNearPoint(position, back.direction, reach, u.w, t, here)) break;
        at = position + back.direction * t;
        stepClampSquared = relaxedClampSquared(reach);
        weight = scatteringOf(s) * overDensity * nearPointWeight(position, back.direction, reach, t);
#else
        light = gathered;
        break;
#endif
    }
#if COMPENSATION == 1
    light = evenCompensation(light, clampSquared, s, back, u.xyz, number);
#endif
    return light;
}

/// Importance of a segment on its ray, as if light were the same everywhere: what it scatters times its transmittance to the eye.
float importanceOf(Segment s, vec3 before) {
    return meanOf(scatteringOf(s) * exp(-before) * oneMinusExpOverX(s.depth));
}

/// What the points along a ray are drawn with: one after the other well spread.
struct PointNumbers {
    uint walks;  // subset of the walks
    float along; // the segment
    vec4 near;   // of the compensating vertex: direction, medium, distance
};

void nextNumbers(inout PointNumbers numbers) {
    ++numbers.walks;
    numbers.along = fract(numbers.along + 0.61803399);
    numbers.near = fract(numbers.near + vec4(0.85667488, 0.73389185, 0.62870672, 0.53859725)); // powers of the root of x⁵ = x + 1
}

const float kLeastImportance = 1e-34; // points over it are finite; what scatters less is not to be seen

/// Nits that reach the ray's origin from up to `distance` metres: gathered at points that are drawn evenly in importance, once it is known how much
/// there is. Only the points of this turn, after `sum`, what earlier turns have found: so that a driver that ends loops after so many rounds ends none.
vec3 lightScatteredAlong(Ray ray, float distance, uvec2 pixel, vec3 sum) {
    March march;
    if (!beginMarch(ray, distance, march)) return sum;
    March again = march;
    Segment s;
    float total = 0.0;
    while (nextSegment(ray, march, s)) total += importanceOf(s, march.before);
    if (!(total > kLeastImportance)) return sum;

    PointNumbers numbers;
    numbers.walks = uint(pixelNoise(pixel, 21u) * float(vpl.subsets)) + 1u;
    vec4 random = pixelRandom(pixel, 12u);
    numbers.along = random.w;
    numbers.near = pixelRandom(pixel, 15u);
    uint other = uint(pixelRandom(pixel, 16u).x * float(vpl.subsets));
    float passed = pixelNoise(pixel, 28u); // in units of a point: one is taken wherever this reaches a whole number
    float perPoint = float(vpl.samples) / total;
    // Point by point, so that invocations side by side gather together however their segments lie.
    march = again;
    float next = floor(passed) + 1.0;
    float expected = 0.0;
    for (uint point = 0u; point < vpl.endPoint; ++point) {
        bool more = true;
        while (more && (next > passed || point < vpl.firstPoint)) {
            if (next > passed) {
                more = nextSegment(ray, march, s);
                if (more) {
                    expected = importanceOf(s, march.before) * perPoint;
                    passed += expected;
                }
            } else { // an earlier turn's
                next += 1.0;
                ++point;
                nextNumbers(numbers);
            }
        }
        if (!more) break;
        next += 1.0;
        GatherPoint at = gatherBySegment(s, numbers.along);
        vec3 position = ray.origin + ray.direction * (s.start + s.size * at.fraction);
        vec3 light = gatherAt(numbers.walks, numbers.walks + other, position, ray.direction, s, numbers.near);
        sum += exp(-march.before) * at.weight * light / expected;
        nextNumbers(numbers);
    }
    return sum;
}
