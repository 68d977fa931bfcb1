// Eye-linear texture coordinates of light @ [HSM, Equation 1]: (s, t, r, q) = T E_e x_eye.
uniform vec4 eye_planes_@[4];
#ifdef TEXTURE_MATRIX_@
uniform mat4 texture_matrix_@;
#endif

#if defined(OVER_W_@)
noperspective out vec4 light_coord_over_w_@;
vec4 light_coord_@ = vec4(0.0);
#elif defined(AFFINE_@)
noperspective out vec4 light_coord_@;
#else
out vec4 light_coord_@;
#endif

void texgen_@(vec4 eye)
{
    vec4 generated = vec4(dot(eye_planes_@[0], eye), dot(eye_planes_@[1], eye),
                          dot(eye_planes_@[2], eye), dot(eye_planes_@[3], eye));
#ifdef TEXTURE_MATRIX_@
    generated = texture_matrix_@ * generated;
#endif
    light_coord_@ = generated;
#ifdef OVER_W_@
    light_coord_over_w_@ = generated / gl_Position.w;
#endif
}
