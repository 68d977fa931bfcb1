// Two texels, NEAREST and clamped: 0 behind light @, 1 before it.
uniform sampler1D side_map_@;

in float side_s_@;

float side_@()
{
    return texture(side_map_@, side_s_@).r;
}
