// GL_SPOT_CUTOFF of 90 degrees at light @ [GL 4.6 compatibility, 12.2.1.1]: the light times 1 at vertices before it, times
// 0 at those behind it. All three vertices of a triangle that is drawn so agree.
flat out float spot_factor_@;

void find_side_@(vec4 eye)
{
    spot_factor_@ = light_coord_@.w > 0.0 ? 1.0 : 0.0;
}
