// The point of the surface that a fragment shows.
#if defined(EYE_POSITION) && !defined(TWO_SIDED)
in vec3 eye_position;
#endif
#ifdef EYE_NORMAL
in vec3 eye_normal;
#endif

Surface surface_here()
{
    Surface surface = Surface(vec3(0.0), vec3(0.0), vec3(0.0));
#ifdef EYE_POSITION
    surface.position = eye_position;
#ifdef SPECULAR
    surface.to_viewer = normalize(-eye_position);
#endif
#endif
#ifdef EYE_NORMAL
    surface.normal = normalize(eye_normal);
#ifdef TWO_SIDED
    if (seen_from_behind(surface.normal))
        surface.normal = -surface.normal;
#endif
#ifdef BUMP
    smooth_normal = surface.normal;
    surface.normal = bumped(eye_normal);
#endif
#endif
    return surface;
}
