// Light of a uniform, one-sided, Lambertian rectangle on a surface, in closed form (Lambert 1760): the polygon is clipped at the
// horizon, and each edge adds the angle it subtends times the cosine of the plane through it and the point.
#ifndef TYNDALL_LIGHTING_RECT_IRRADIANCE
#define TYNDALL_LIGHTING_RECT_IRRADIANCE

float rectEdge(vec3 from, vec3 to, vec3 normal) {
    vec3 c = cross(from, to);
    float sine = length(c); // times both lengths, which cancel in the angle
    return sine > 0.0 ? atan(sine, dot(from, to)) / sine * dot(c, normal) : 0.0;
}

// Irradiance on a surface with this normal for radiance 1, in sr; `centre` is relative to the point, `halfX` and `halfY` are the
// half extents, `facing` the unit direction in which the rectangle shines. 0 to π.
float rectIrradiance(vec3 centre, vec3 halfX, vec3 halfY, vec3 facing, vec3 normal) {
    float behind = dot(centre, facing); // negative: the point is on the side that is lit
    float distanceSquared = dot(centre, centre);
    if (!(behind < 0.0) || !(distanceSquared > 0.0)) return 0.0;
    float area = 4.0 * length(cross(halfX, halfY));
    float size = max(dot(halfX, halfX), dot(halfY, halfY));
    if (size < 2e-6 * distanceSquared) {
        // So small that the edges' sum cancels: a point with the area's cosine is as good.
        float away = inversesqrt(distanceSquared);
        return max(0.0, dot(centre, normal) * away) * (-behind * away) * area / distanceSquared;
    }
    vec3 corners[4] = vec3[4](centre - halfX - halfY, centre + halfX - halfY, centre + halfX + halfY, centre - halfX + halfY);
    float sum = 0.0;
    bool opened = false;
    vec3 leaving = vec3(0.0), entering = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec3 from = corners[i];
        vec3 to = corners[(i + 1) & 3];
        float heightFrom = dot(from, normal);
        float heightTo = dot(to, normal);
        if (heightFrom <= 0.0 && heightTo <= 0.0) continue;
        if (heightFrom < 0.0) {
            from = mix(from, to, heightFrom / (heightFrom - heightTo));
            entering = from;
            opened = true;
        } else if (heightTo < 0.0) {
            to = mix(from, to, heightFrom / (heightFrom - heightTo));
            leaving = to;
            opened = true;
        }
        sum += rectEdge(from, to, normal);
    }
    // The edge along the horizon closes the polygon. The plane through it contains the point's horizon: its part is the angle itself.
    if (opened) sum += rectEdge(leaving, entering, normal);
    return 0.5 * abs(sum);
}

/// Solid angle of the same rectangle, sr: 0 behind it, up to 2π right in front. As two triangles (Van Oosterom and Strackee 1983, "The Solid Angle of a Plane
/// Triangle"); their triple product is the rectangle's area times the height above it, so that nothing cancels far away.
float rectSolidAngle(vec3 centre, vec3 halfX, vec3 halfY, vec3 facing) {
    float height = -dot(centre, facing);
    if (!(height > 0.0)) return 0.0;
    vec3 a = centre - halfX - halfY;
    vec3 b = centre + halfX - halfY;
    vec3 c = centre + halfX + halfY;
    vec3 d = centre - halfX + halfY;
    vec4 lengths = vec4(length(a), length(b), length(c), length(d));
    float product = 4.0 * length(cross(halfX, halfY)) * height;
    float ac = dot(a, c);
    float first = lengths.x * lengths.y * lengths.z + dot(a, b) * lengths.z + ac * lengths.y + dot(b, c) * lengths.x;
    float second = lengths.x * lengths.z * lengths.w + ac * lengths.w + dot(a, d) * lengths.z + dot(c, d) * lengths.x;
    return 2.0 * (atan(product, first) + atan(product, second));
}

#endif
