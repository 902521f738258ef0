// The rest state that cuts and textures ask of a vertex (render/surface_vertices.h: RestVertex).
layout(location = 7) in vec4 a_rest; // position at rest in its box; w: the side of a cut, in 1/65535

/// Of a cut that the vertex follows: -1, 1; 0: both.
float vertexSide() {
    return round(a_rest.w * 65535.0) - 1.0;
}
