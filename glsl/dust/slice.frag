// A slice of light @'s beam in dusty air [LEC, "Combining Shadows with Atmospherics"]: the light that a layer of air scatters to the eye,
// and with OVER its opacity in alpha. The colour has that opacity as a factor already.
#ifdef ATTENUATION_@
uniform vec3 attenuation_@;
uniform vec3 light_position_@;
#endif
uniform vec3 light_diffuse_@;
// Extinction times the distance of two slices along the view axis.
uniform float optical_depth;
// The way of the view ray through a pixel, at distance 1 along the view axis: scale, then offset.
uniform vec4 ray_from_pixel;

out vec4 fragment;

void main()
{
    vec2 ray = ray_from_pixel.xy * gl_FragCoord.xy + ray_from_pixel.zw;
#ifdef JITTER
    place_slice(jitter_here());
#endif
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
    // A ray at an angle phi to the view axis is 1 / cos phi as long in the layer as the axis.
#ifdef SECANT
    float optical = optical_depth * sqrt(1.0 + dot(ray, ray));
#else
    float optical = optical_depth;
#endif
#ifdef PROJECTED_@
    find_image_@();
#endif
    if (!in_reach_@())
        discard;
    float shade = shade_@();
    vec3 light = shade * light_diffuse_@;
#ifdef PROJECTED_@
    light *= projected_@();
#endif
#ifdef ATTENUATION_@
    float away = distance(vec3(ray, -1.0) / gl_FragCoord.w, light_position_@);
    light /= dot(attenuation_@, vec3(1.0, away, away * away));
#endif
#ifdef OVER
    // 1 - exp(-x), by its series where the difference would cancel: below 0.02. THIN: all depths are below, THICK: none.
#ifdef THIN
    float opacity = optical * (1.0 - 0.5 * optical * (1.0 - optical / 3.0));
#elif defined(THICK)
    float opacity = 1.0 - exp(-optical);
#else
    float opacity = optical < 0.02 ? optical * (1.0 - 0.5 * optical * (1.0 - optical / 3.0)) : 1.0 - exp(-optical);
#endif
#ifdef HIDES_IN_SHADOW
    fragment = vec4(opacity * light, opacity);
#else
    fragment = opacity * vec4(light, shade);
#endif
#else
    fragment = vec4(optical * light, 0.0);
#endif
}
