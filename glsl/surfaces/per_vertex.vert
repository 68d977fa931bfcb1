// Light @ per vertex, clamped as fixed-function lighting clamps its one colour: ambient first, then diffuse, then
// specular in what is left below 1.
EXACT out vec3 vertex_diffuse_@;
#ifdef LIGHT_AMBIENT_@
EXACT out vec3 vertex_ambient_@;
#endif
#ifdef SPECULAR
EXACT out vec3 vertex_specular_@;
#endif

void light_vertex_@(Surface surface)
{
    EXACT Lit lit = lighting_@(surface);
    EXACT vec3 room = max(vec3(1.0) - scene_ambient, 0.0);
#ifdef LIGHT_AMBIENT_@
    vertex_ambient_@ = min(lit.ambient, room);
    room -= vertex_ambient_@;
#endif
    vertex_diffuse_@ = min(lit.diffuse, room);
#ifdef SPECULAR
    vertex_specular_@ = min(lit.specular, room - vertex_diffuse_@);
#endif
}
