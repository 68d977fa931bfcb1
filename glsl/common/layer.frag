// A layer of floats, to be blended over the picture, texel by texel.
uniform sampler2D layer;

out vec4 fragment;

void main()
{
    fragment = texelFetch(layer, ivec2(gl_FragCoord.xy), 0);
}
