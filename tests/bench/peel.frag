#version 330 core
uniform sampler2D nearest;
void main()
{
    float own = gl_FragCoord.z;
    float first = texelFetch(nearest, ivec2(gl_FragCoord.xy), 0).r;
    if (own - 2.0 / 16777215.0 <= first)
        discard;
    gl_FragDepth = 0.5 * (first + own);
}
