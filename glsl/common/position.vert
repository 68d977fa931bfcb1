// gl_Position of every pass, by the same arithmetic, so that passes with depth EQUAL agree to the bit
// [GL 4.6 compatibility, A.3 and 11.1.3.11].
// w is 1 where a mesh has three coordinates [GL 4.6, 10.3.1], 0 at a shadow volume's far end.
layout(location = 0) in vec4 position;

uniform mat4 clip_from_model;

invariant gl_Position;

void set_position()
{
    gl_Position = clip_from_model * position;
#ifdef CLIP_NEAR
    // Under depth clamp the near plane clips all the same: a vertex beside the eye has no usable depth.
    gl_ClipDistance[0] = gl_Position.z + gl_Position.w;
#endif
}
