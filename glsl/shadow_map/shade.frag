// One comparison of the texture unit [GL 4.6, 8.23.1]: r/q against the map at (s/q, t/q); 1 lit, 0 shadowed, between them
// what GL_LINEAR makes of four comparisons.
float shade_@()
{
    vec4 coord = light_coord_@;
#ifdef CLAMP_REFERENCE_@
    // Fixed-point maps clamp the reference to [0, 1]; for floating-point maps the shader does, or all beyond far is dark.
    coord.z = clamp(coord.z, 0.0, coord.w);
#endif
    return textureProj(shadow_map_@, coord);
}
