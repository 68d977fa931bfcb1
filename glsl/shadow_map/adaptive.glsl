// Adaptive bias [Dou 2014]: each texel is compared with the receiver's own plane where the light's ray through the
// texel's centre meets it. GL_LINEAR's one reference cannot be right for four texels, so the texels are read one by one
// (GL_NEAREST), and the shader applies the weights.
uniform float towards_light_@; // 1, or -1 where depth is reversed

float compare_@(vec2 centre, vec3 at, vec2 size)
{
#ifndef PARALLEL_@
    // Beyond the frustum the texel beside it is met, and met where it lies.
    centre = clamp(centre, vec2(0.5), size - 0.5);
#endif
    vec2 texture_coord = centre / size;
    // Beyond its facet the receiver's plane is no surface: where it falls away from the light, the next facet may not.
    float along = dot(receiver_slope_@, texture_coord - at.xy);
    float reference = at.z + towards_light_@ * min(towards_light_@ * along, 0.0);
    return texture(shadow_map_@, vec3(texture_coord, clamp(reference, 0.0, 1.0)));
}
