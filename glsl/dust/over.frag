// A light's dust over the picture, texel by texel.
uniform sampler2D dust;

out vec4 fragment;

void main()
{
    fragment = texelFetch(dust, ivec2(gl_FragCoord.xy), 0);
}
