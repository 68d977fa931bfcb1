#ifdef EYE_SPACE
uniform mat4 eye_from_model;
#endif
#ifdef NORMALS
layout(location = 1) in vec3 normal;
uniform mat3 eye_from_model_normal;
#endif
#if defined(BUMP) || defined(COMBINED)
layout(location = 3) in vec3 tangent;
layout(location = 4) in vec3 bitangent;
#endif
#ifdef BUMP
out vec3 eye_tangent;
out vec3 eye_bitangent;
#endif
#ifdef EYE_POSITION
out vec3 eye_position;
#endif
#ifdef EYE_NORMAL
out vec3 eye_normal;
#endif
#ifdef VERTEX_COLORS
layout(location = 5) in vec3 vertex_color;
out vec3 own_vertex_color;
#endif
#ifdef CLIP_PLANES
// Half-spaces in eye space; what is kept has a product >= 0.
uniform vec4 clip_planes[CLIP_PLANES];
out float gl_ClipDistance[CLIP_PLANES];
#endif

void main()
{
    set_position();
#ifdef DECAL_COORDINATES
    set_decal();
#endif
#ifdef VERTEX_COLORS
    own_vertex_color = vertex_color;
#endif
#ifdef EYE_SPACE
    vec4 eye = eye_from_model * model_position;
    TEXGEN(eye)
#ifdef PHOTO_TEXGEN
    PHOTO_TEXGEN(eye)
#endif
#ifdef CLIP_PLANES
    for (int k = 0; k < CLIP_PLANES; ++k)
        gl_ClipDistance[k] = dot(clip_planes[k], eye);
#endif
#endif
#ifdef EYE_POSITION
    eye_position = eye.xyz;
#endif
#ifdef EYE_NORMAL
    eye_normal = eye_from_model_normal * waved_normal(normal);
#endif
#if defined(BUMP) || defined(COMBINED)
    // By the matrix of normals: that of T, B and N times a normal of tangent space is the surface's, however it is scaled.
    vec3 t = eye_from_model_normal * waved_beside(tangent, normal);
    vec3 b = eye_from_model_normal * waved_beside(bitangent, normal);
#endif
#ifdef BUMP
    eye_tangent = t;
    eye_bitangent = b;
#endif
#ifdef COMBINED
    TANGENT_VECTORS(eye.xyz, mat3(t, b, eye_from_model_normal * waved_normal(normal)))
#endif
#ifdef PER_VERTEX
#ifdef UNLIT
    Surface surface = Surface(eye.xyz, vec3(0.0), vec3(0.0, 0.0, 1.0));
#else
    // GL_LIGHT_MODEL_LOCAL_VIEWER is off, as it is by default.
    Surface surface = Surface(eye.xyz, normalize(eye_from_model_normal * waved_normal(normal)), vec3(0.0, 0.0, 1.0));
#endif
    LIGHT_VERTEX(surface)
#endif
}
