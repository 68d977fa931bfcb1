// Eye-linear texture coordinates of light @ [HSM, Equation 1]: (s, t, r, q) = T E_e x_eye.
uniform vec4 eye_planes_@[4];
#ifdef TEXTURE_MATRIX_@
uniform mat4 texture_matrix_@;
#endif

out vec4 light_coord_@;

void texgen_@(vec4 eye)
{
    vec4 generated = vec4(dot(eye_planes_@[0], eye), dot(eye_planes_@[1], eye),
                          dot(eye_planes_@[2], eye), dot(eye_planes_@[3], eye));
#ifdef TEXTURE_MATRIX_@
    generated = texture_matrix_@ * generated;
#endif
    light_coord_@ = generated;
}
