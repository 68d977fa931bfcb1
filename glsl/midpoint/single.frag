// Where the second pass found no second layer, the nearest one.
uniform sampler2D midpoint;
uniform sampler2D nearest;

#ifdef REVERSED
const float CLEARED = 0.0;
#else
const float CLEARED = 1.0;
#endif

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    float middle = texelFetch(midpoint, texel, 0).r;
    gl_FragDepth = middle == CLEARED ? texelFetch(nearest, texel, 0).r : middle;
}
