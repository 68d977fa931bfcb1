// What light/texgen.vert generated for light @, interpolated; divided by q where it is looked up.
in vec4 light_coord_@;
