// The material, a point of the surface, and what light does to it.
uniform vec3 scene_ambient; // the scene's ambient light times the material's
#ifdef MATERIAL_AMBIENT
uniform vec3 material_ambient;
#endif
#ifdef COLORLESS
const vec3 material_diffuse = vec3(1.0); // the surface's own colour is another factor
#elif defined(ANY_LIGHT)
uniform vec3 material_diffuse;
#endif
#ifdef SPECULAR
uniform vec3 material_specular;
uniform float shininess;
#endif

struct Surface {
    vec3 position;  // in eye space
    vec3 normal;    // of unit length, in eye space
    vec3 to_viewer; // of unit length
};

struct Lit {
    vec3 ambient;
    vec3 diffuse;
    vec3 specular;
};
