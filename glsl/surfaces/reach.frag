// Tests whether spotlight @ can light a point: it is before the light (q > 0, no back projection), inside the sides of its
// frustum and, for a cone, inside the circle inscribed in them.
#ifdef MAP_ADDRESSING_@
// The frustum's [0, 1] square from the map's s and t: scale, then offset.
uniform vec4 frustum_from_map_@;
#endif

// (s, t, q) over the frustum's cross-section, [0, 1] after division.
vec3 frustum_coord_@()
{
#ifdef MAP_ADDRESSING_@
    vec2 st = light_coord_@.xy * frustum_from_map_@.xy + light_coord_@.w * frustum_from_map_@.zw;
    return vec3(st, light_coord_@.w);
#else
    return light_coord_@.xyw;
#endif
}

bool in_reach_@()
{
    vec3 coord = frustum_coord_@();
    float half_q = 0.5 * coord.z;
    vec2 off = coord.xy - half_q;
#ifdef CONE_@
    bool inside = dot(off, off) <= half_q * half_q;
#else
    bool inside = abs(off.x) <= abs(half_q) && abs(off.y) <= abs(half_q);
#endif
#ifdef UNGUARDED_@
    // No test of q > 0: another guard already removes surfaces behind the light.
    return inside;
#else
    return coord.z > 0.0 && inside;
#endif
}
