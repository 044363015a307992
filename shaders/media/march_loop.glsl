// The loop of every march: a ray's segments one after the other, with what lies before each. What is gathered in a segment is up to who marches:
//
//     March march;
//     Segment s;
//     if (beginMarch(ray, distance, march))
//         while (nextSegment(ray, march, s)) sum += exp(-march.before) * …
//
// Inside a segment use closed forms (oneMinusExpOverX(s.depth)): then a constant source sends the same for any number of segments.
#ifndef TYNDALL_MEDIA_MARCH_LOOP
#define TYNDALL_MEDIA_MARCH_LOOP
#include "media/march_segment.glsl"

const int kMostSegments = 16384; // ends a march whose coordinates have lost their meaning

struct March {
    vec3 before; // optical depth from the ray's origin to the segment; behind the last one, of all
    float next;  // metres at which the next segment begins
    float end;
    float opaque; // optical depth at which the march ends (MediaHeader.minTransmittance)
    vec3 depth;   // of the segment
    int count;
};

/// False where no medium is on the ray's way of `distance` metres (1e30: endless) to gather light from.
bool beginMarch(Ray ray, float distance, out March march) {
    march.before = vec3(0.0);
    march.depth = vec3(0.0);
    march.count = 0;
    march.opaque = -log(max(mediaHeader.minTransmittance, 1e-30));
    return mediaExtent(ray, distance, march.next, march.end);
}

/// False at the end: there is no segment then.
bool nextSegment(Ray ray, inout March march, out Segment s) {
    march.before = min(march.before + march.depth, vec3(kOpaque));
    bool more = march.count++ < kMostSegments && march.next < march.end && minimumOf(march.before) < march.opaque;
    if (more) {
        s = marchSegment(ray, march.next, march.end);
        march.next = s.start + s.size;
        march.depth = s.depth;
    }
    return more;
}

#endif
