// Side of a surface that is seen.
#ifdef EYE_POSITION
in vec3 eye_position;
#endif

// Tests whether a surface with this normal is seen from behind, whichever way the file winds it: both the normal and, so
// that smooth silhouettes and slivers keep theirs, the facet say so.
bool seen_from_behind(vec3 normal)
{
    // By shares of the distance: products of lengths may be too small for a float.
    vec3 way = abs(eye_position);
    float unit = 1.0 / max(way.x, max(way.y, way.z));
    vec3 facet = cross(unit * dFdx(eye_position), unit * dFdy(eye_position)); // towards the viewer
    return dot(normal, eye_position) > 0.0 && dot(normal, facet) < 0.0;
}
