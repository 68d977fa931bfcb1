// Normal offset: the map is looked up for a point that is moved along the surface's normal, by as much as the filter
// reaches times the sine of the light's angle: a plane then lies before all that the filter meets of it.
uniform sampler2DShadow shadow_map_@;
#ifdef PARALLEL_@
uniform mat4 light_from_texture_@;  // of a box, not of a frustum
#else
uniform vec4 light_from_map_@;      // x and y over the distance from s/q and t/q: scale, then what is taken off first
#endif
uniform mat4 texture_from_light_@;
uniform float offset_radius_@;      // at a distance of 1 from the light; of parallel light, anywhere

vec4 offset_coord_@ = vec4(0.0);

// Before any branch: derivatives are not defined within one.
void derive_shade_@()
{
    vec4 coord = light_coord_@;
    // In light space.
#ifdef PARALLEL_@
    vec3 point = (light_from_texture_@ * coord).xyz;
    const vec3 to_light = vec3(0.0, 0.0, 1.0);
#else
    vec3 point = vec3((coord.xy - light_from_map_@.zw * coord.w) * light_from_map_@.xy, -coord.w);
    vec3 to_light = normalize(-point);
#endif
    vec3 normal = normalize(cross(dFdx(point), dFdy(point))); // to the viewer
    float sine = length(cross(normal, to_light));
    // Of parallel light q is 1.
    offset_coord_@ = coord + offset_radius_@ * coord.w * sine * (texture_from_light_@ * vec4(normal, 0.0));
}

float shade_@()
{
    vec3 at = offset_coord_@.xyz / offset_coord_@.w;
    at.z = clamp(at.z, 0.0, 1.0);
    vec2 texel = 1.0 / vec2(textureSize(shadow_map_@, 0));
    const float FIRST = 0.5 * float(1 - KERNEL_@);
    float lit = 0.0;
    for (int y = 0; y < KERNEL_@; ++y)
        for (int x = 0; x < KERNEL_@; ++x)
            lit += texture(shadow_map_@, vec3(at.xy + (FIRST + vec2(x, y)) * texel, at.z));
    return lit / float(KERNEL_@ * KERNEL_@);
}
