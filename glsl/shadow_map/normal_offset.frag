// Normal offset: the map is looked up for a point that is moved along the surface's normal n, so far that the surface's
// plane lies before none of the texels that the filter meets.
//
// Of a plane n . x = -h before the light, 1/w is linear in the map's u and v, with the gradient -(n.x, n.y) / h; w is the
// distance along the light's axis. A point moved by d along n lies on the plane at h - d. There 1/w is at least what the
// first plane has anywhere within (a, b) in u and v if d = w (a |n.x| + b |n.y|), w being that of the moved point. So the
// angle that counts is the normal's with the light's axis, not with the light's ray. Of parallel light w is 1.
#ifdef PARALLEL_@
uniform mat4 light_from_texture_@;  // of a box, not of a frustum
#else
uniform vec4 light_from_map_@;      // x and y over the distance from s/q and t/q: scale, then what is taken off first
#endif
uniform mat4 texture_from_light_@;
uniform vec2 offset_reach_@;        // (a, b)

vec4 offset_coord_@ = vec4(0.0);

// A vector's direction, with components up to 1: its square is then neither too large nor too small for a float.
vec3 scaled_@(vec3 way)
{
    vec3 size = abs(way);
    return way / max(max(size.x, max(size.y, size.z)), 1e-37);
}

// Before any branch: derivatives are not defined within one.
void derive_shade_@()
{
    vec4 coord = light_coord_@;
    // In light space.
#ifdef PARALLEL_@
    vec3 point = (light_from_texture_@ * coord).xyz;
#else
    vec3 point = vec3((coord.xy - light_from_map_@.zw * coord.w) * light_from_map_@.xy, -coord.w);
#endif
    // Over w what is interpolated is linear in the picture, and so is 1/w: derivatives of these are exact, though the pixel
    // beside lies past the surface's horizon, where the point itself comes back from behind the eye.
    float w = gl_FragCoord.w;
    vec3 dx = dFdx(point * w) - point * dFdx(w);
    vec3 dy = dFdy(point * w) - point * dFdy(w);
    vec3 normal = cross(scaled_@(dx), scaled_@(dy)); // to the viewer
    normal *= inversesqrt(max(dot(normal, normal), 1e-30));
    float reach = dot(offset_reach_@, abs(normal.xy));
#ifndef PARALLEL_@
    // From the point's own w to that of the moved one.
    reach /= max(1.0 + reach * normal.z, 0.5);
#endif
    // Of parallel light q is 1.
    offset_coord_@ = coord + reach * coord.w * (texture_from_light_@ * vec4(normal, 0.0));
}
