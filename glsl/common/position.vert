// gl_Position of every pass, by the same arithmetic, so that passes with depth EQUAL agree to the bit
// [GL 4.6 compatibility, A.3 and 11.1.3.11].
// w is 1 where a mesh has three coordinates [GL 4.6, 10.3.1], 0 at a shadow volume's far end.
layout(location = 0) in vec4 position;

uniform mat4 clip_from_model;

invariant gl_Position;

#ifdef WAVE
// The vertex moves to p + reach sin(2 pi (vector . p + phase)); the phase, in turns, is the vector's w.
uniform vec3 wave_reach;
uniform vec4 wave_vector;

vec4 model_position = vec4(0.0);

const float WAVE_TURN = 6.28318530717958648;

// Within half a turn of 0, where sine and cosine are best.
float wave_angle()
{
    float turn = dot(wave_vector.xyz, position.xyz) + wave_vector.w;
    return WAVE_TURN * (turn - floor(turn + 0.5));
}

// A normal by the cofactors of the Jacobian I + 2 pi cos(...) reach vector^T, which are its inverse transpose times its
// determinant: it turns with the triangles where the surface folds over. Of unit length, so that none weighs more than
// its neighbours between the vertices.
vec3 waved_normal(vec3 normal)
{
    float slope = WAVE_TURN * cos(wave_angle());
    vec3 waved = normal * (1.0 + slope * dot(wave_vector.xyz, wave_reach))
                 - slope * dot(wave_reach, normal) * wave_vector.xyz;
    return waved * inversesqrt(max(dot(waved, waved), 1e-30));
}

// Another direction of the surface, by the same cofactors and as a share of the normal's length: a sum of both moves as a
// normal does.
vec3 waved_beside(vec3 direction, vec3 normal)
{
    float slope = WAVE_TURN * cos(wave_angle());
    float folded = 1.0 + slope * dot(wave_vector.xyz, wave_reach);
    vec3 waved = direction * folded - slope * dot(wave_reach, direction) * wave_vector.xyz;
    vec3 beside = normal * folded - slope * dot(wave_reach, normal) * wave_vector.xyz;
    return waved * inversesqrt(max(dot(beside, beside), 1e-30));
}
#else
#define model_position position
#define waved_normal(normal) (normal)
#define waved_beside(direction, normal) (direction)
#endif

void set_position()
{
#ifdef WAVE
    model_position = vec4(position.xyz + wave_reach * sin(wave_angle()), 1.0);
#endif
    gl_Position = clip_from_model * model_position;
#ifdef CLIP_NEAR
    // Under depth clamp the near plane clips all the same: a vertex beside the eye has no usable depth.
    gl_ClipDistance[0] = gl_Position.z + gl_Position.w;
#endif
}
