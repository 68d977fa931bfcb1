// The second pass of Woo's midpoint map [HSM, "Advantages and Limitations"]: the nearest layer is
// peeled away at the fragment's own texel; what is left writes the middle between its own depth and the nearest one, and
// the depth test keeps the least.
uniform sampler2D nearest;
#ifdef COMPARE
uniform sampler2DShadow nearest_compared; // GL_GREATER: 1 behind the nearest layer
#endif
// What a depth may lose when it is stored: the first layer's own fragments must not lie behind themselves. It stands for a
// surface across the light; a steep one loses more.
uniform float margin;
#ifdef EYE_LINEAR
uniform float near_over_range; // n / (f - n)
#endif

void main()
{
    float own = gl_FragCoord.z;
    // Depth is interpolated as z0 + x dz/dx + y dz/dy from a corner of the map, in f32: beside the sum the products are
    // rounded, and two triangles in one plane differ by that too.
    float apart = margin * (1.0 + fwidth(own) * float(textureSize(nearest, 0).x));
    alpha_test();
#ifdef CLAMPED
    // The depth test, which comes later, clamps alike [GL 4.6, 17.3.4].
    own = clamp(own, 0.0, 1.0);
#endif
    float first = texelFetch(nearest, ivec2(gl_FragCoord.xy), 0).r;
#ifdef COMPARE
    // By the texture unit, as the document does it.
    vec2 texel_centre = gl_FragCoord.xy / vec2(textureSize(nearest, 0));
    bool is_behind = texture(nearest_compared, vec3(texel_centre, own - apart)) != 0.0;
#elif defined(REVERSED)
    bool is_behind = own - apart < first;
#else
    bool is_behind = own - apart > first;
#endif
    if (!is_behind)
        discard;
    float middle = 0.5 * (first + own);
#ifdef EYE_LINEAR
    // The window depth of the middle point. With u = f/(f - n) - z, which is as 1 over the distance, it is the harmonic
    // mean of both u: their mean less the square of half their difference over it.
    float half_gap = 0.5 * (own - first);
#ifdef REVERSED
    middle -= half_gap * half_gap / (near_over_range + middle);
#else
    middle += half_gap * half_gap / (near_over_range + 1.0 - middle);
#endif
#endif
    gl_FragDepth = middle;
}
