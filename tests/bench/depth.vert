#version 330 core
layout(location = 0) in vec3 position;
uniform mat4 clip_from_world;
uniform vec3 offset;
void main()
{
    gl_Position = clip_from_world * vec4(position + offset, 1.0);
}
