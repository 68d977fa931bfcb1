#ifdef EYE_POSITION
in vec3 eye_position;
#endif
#ifdef EYE_NORMAL
in vec3 eye_normal;
#endif
#ifdef DECAL
#ifndef ALPHA_TEST
in vec2 st;
#endif
uniform sampler2D decal_map;
#endif

EXACT out vec4 fragment;

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
    // Seen from behind, whichever way the file winds it: both the normal and, so that smooth silhouettes and slivers
    // keep theirs, the facet say so.
    // By shares of the distance: products of lengths may be too small for a float.
    vec3 way = abs(eye_position);
    float unit = 1.0 / max(way.x, max(way.y, way.z));
    vec3 facet = cross(unit * dFdx(eye_position), unit * dFdy(eye_position)); // towards the viewer
    if (dot(surface.normal, eye_position) > 0.0 && dot(surface.normal, facet) < 0.0)
        surface.normal = -surface.normal;
#endif
#endif
    return surface;
}

void main()
{
    alpha_test();
    EXACT Lit lit = Lit(scene_ambient, vec3(0.0), vec3(0.0));
#ifdef ANY_LIGHT
    Surface surface = surface_here();
    ILLUMINATE(surface, lit)
#endif
#ifdef ADDED
    EXACT vec3 color = lit.diffuse; // ambient light is there
#else
    EXACT vec3 color = lit.ambient + lit.diffuse;
#endif
#ifdef DECAL
    color *= texture(decal_map, DECAL_ST).rgb;
#endif
#ifdef SPECULAR
    color += lit.specular;
#endif
#ifdef PHOTOGRAPH
    vec4 photo = vec4(0.0);
    PHOTOGRAPH(photo, eye_position)
    if (photo.a > 0.0)
#ifdef PHOTO_THERE
        color = vec3(0.0); // no light falls on it
#else
        color = photo.rgb;
#endif
#endif
    fragment = vec4(color, 1.0);
}
