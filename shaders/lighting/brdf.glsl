// glTF 2.0, appendix B: metallic-roughness, with KHR_materials_specular's weight on the dielectric's Fresnel term.
//
//   dielectric = mix(baseColor/π, V·D, specular · Schlick(0.04))     metal = Schlick(baseColor) · V·D
//   material   = mix(dielectric, metal, metallic),  α = roughness²,  D of Trowbridge and Reitz (GGX), V separable Smith
//
// `specular` 0 on a dielectric is exactly Lambert. One deviation: α is at least kMinAlpha, for below it a lobe is narrower
// than the normals are precise; a mirror shows a light as a spot 0.06 degrees wide instead of none.
#ifndef TYNDALL_LIGHTING_BRDF
#define TYNDALL_LIGHTING_BRDF

const float kBrdfPi = 3.14159265358979;
const float kMinAlpha = 1e-3;
const float kDielectricF0 = 0.04; // index of refraction 1.5

struct Brdf {
    vec3 baseColor;
    float metallic;
    float alpha;
    float specular;
};

// Parts of the BRDF without the cosine: what the base scatters, and what the microfacets reflect. 1/sr.
struct BrdfValue {
    vec3 diffuse;
    vec3 specular;
};

Brdf makeBrdf(vec3 baseColor, float metallic, float roughness, float specular) {
    return Brdf(baseColor, metallic, max(roughness * roughness, kMinAlpha), specular);
}

float schlickWeight(float cosine) {
    float m = clamp(1.0 - cosine, 0.0, 1.0);
    return m * m * m * m * m;
}

// Fresnel factors of the coat of a dielectric and of a metal.
float dielectricFresnel(Brdf brdf, float viewDotHalf) {
    return brdf.specular * (kDielectricF0 + (1.0 - kDielectricF0) * schlickWeight(viewDotHalf));
}

vec3 metalFresnel(Brdf brdf, float viewDotHalf) {
    return brdf.baseColor + (1.0 - brdf.baseColor) * schlickWeight(viewDotHalf);
}

// Of all that microfacets reflect, dielectric and metal mixed.
vec3 specularFresnel(Brdf brdf, float viewDotHalf) {
    return mix(vec3(dielectricFresnel(brdf, viewDotHalf)), metalFresnel(brdf, viewDotHalf), brdf.metallic);
}

// GGX. The denominator (n·h)²(α²-1)+1 cancels where n·h is near 1; |n×h|² is 1-(n·h)² without the loss.
float ggxDistribution(float alpha, vec3 normal, vec3 halfway) {
    vec3 c = cross(normal, halfway);
    float cosine = alpha * dot(normal, halfway);
    float d = cosine * cosine + dot(c, c);
    return dot(normal, halfway) > 0.0 ? alpha * alpha / (kBrdfPi * d * d) : 0.0;
}

// One factor of V: G₁(cosine) / (2·cosine).
float smithVisibility(float alpha, float cosine) {
    float a2 = alpha * alpha;
    return 1.0 / (cosine + sqrt(a2 + (1.0 - a2) * cosine * cosine));
}

// `toLight` above the surface: what microfacets would reflect were Fresnel's factor 1, 1/sr. The factor follows from `viewDotHalf`.
float microfacetReflection(Brdf brdf, vec3 normal, vec3 toEye, vec3 toLight, out float viewDotHalf) {
    float normalDotLight = dot(normal, toLight);
    vec3 sum = toEye + toLight;
    float squared = dot(sum, sum);
    // Eye and light exactly opposite: grazing both, nothing is reflected.
    vec3 halfway = squared > 1e-12 ? sum * inversesqrt(squared) : normal;
    viewDotHalf = clamp(dot(toEye, halfway), 0.0, 1.0);
    // A normal map or a smooth normal can face away from the eye that sees the surface: |n·v|, as the appendix has it.
    return ggxDistribution(brdf.alpha, normal, halfway) * smithVisibility(brdf.alpha, normalDotLight) *
           smithVisibility(brdf.alpha, abs(dot(normal, toEye)));
}

// Unit vectors: `toEye` and `toLight` away from the surface. 0 for light from behind.
BrdfValue evaluateBrdf(Brdf brdf, vec3 normal, vec3 toEye, vec3 toLight) {
    if (!(dot(normal, toLight) > 0.0)) return BrdfValue(vec3(0.0), vec3(0.0));
    float viewDotHalf;
    float microfacets = microfacetReflection(brdf, normal, toEye, toLight, viewDotHalf);
    BrdfValue value;
    value.diffuse = (1.0 - brdf.metallic) * (1.0 - dielectricFresnel(brdf, viewDotHalf)) / kBrdfPi * brdf.baseColor;
    value.specular = specularFresnel(brdf, viewDotHalf) * microfacets;
    return value;
}

// A right-handed frame around `normal`, without a seam at any axis (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
mat3 frameAround(vec3 normal) {
    float s = normal.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + normal.z);
    float b = normal.x * normal.y * a;
    return mat3(vec3(1.0 + s * normal.x * normal.x * a, s * b, -s * normal.x), vec3(b, s + normal.y * normal.y * a, -normal.y), normal);
}

// A microfacet normal among those that `toEye` sees (Heitz 2018, "Sampling the GGX Distribution of Visible Normals"); local
// frame, z along the normal, toEye.z ≥ 0. The light direction reflect(-toEye, h) then has the density G₁(eye)·D(h)/(4·eye.z),
// and BRDF·cosine/density is Fresnel·G₁(light).
vec3 sampleVisibleNormal(float alpha, vec3 toEye, vec2 u) {
    vec3 stretched = normalize(vec3(alpha * toEye.xy, toEye.z));
    float lengthSquared = dot(stretched.xy, stretched.xy);
    vec3 across = lengthSquared > 0.0 ? vec3(-stretched.y, stretched.x, 0.0) * inversesqrt(lengthSquared) : vec3(1.0, 0.0, 0.0);
    vec3 along = cross(stretched, across);
    float radius = sqrt(u.x);
    float angle = 2.0 * kBrdfPi * u.y;
    float p = radius * cos(angle);
    float q = radius * sin(angle);
    q = mix(sqrt(max(0.0, 1.0 - p * p)), q, 0.5 * (1.0 + stretched.z));
    vec3 n = p * across + q * along + sqrt(max(0.0, 1.0 - p * p - q * q)) * stretched;
    return normalize(vec3(alpha * n.xy, max(1e-7, n.z)));
}

#endif
