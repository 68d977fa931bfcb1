// Photograph @, projected back onto the surface that it shows [Segal 1992, 3.1]. photo.a is 1 where it decides the colour.
#ifdef PHOTO_FACING_@
uniform vec3 photo_eye_@; // in eye space
#endif

// at: the point in eye space, where PHOTO_FACING_@ needs it.
void photograph_@(inout vec4 photo, vec3 at)
{
#ifdef PHOTO_GREY_@
    photo = vec4(vec3(128.0 / 255.0), 1.0);
#endif
#ifdef PHOTO_LOOKED_UP_@
#ifdef DERIVATIVES_@
    derive_shade_@();
#endif
#ifdef PHOTO_COLOR_@
    find_image_@();
#endif
#if !defined(PHOTO_SMEARED_@)
#ifdef PHOTO_FACING_@
    // The side that is seen must be the side that was photographed. By shares of the distance: products of lengths may be
    // too small for a float.
    vec3 way = abs(at);
    float unit = 1.0 / max(way.x, max(way.y, way.z));
    vec3 facet = cross(unit * dFdx(at), unit * dFdy(at)); // towards the viewer
    bool faces = dot(facet, unit * (photo_eye_@ - at)) > 0.0;
#else
    const bool faces = true;
#endif
    bool shown = faces && in_reach_@();
    if (shown)
        shown = shade_@() >= 0.5; // one bit, as a tag of a shadow is
#elif defined(UNGUARDED_@)
    const bool shown = true;
#else
    bool shown = frustum_coord_@().z > 0.0;
#endif
    if (shown) {
#ifdef PHOTO_COLOR_@
        photo = vec4(projected_@(), 1.0);
#else
        photo.a = 1.0;
#endif
    }
#endif
}
