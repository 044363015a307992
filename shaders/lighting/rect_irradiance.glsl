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

#endif
