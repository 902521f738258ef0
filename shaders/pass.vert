// One triangle that covers the viewport, from gl_VertexID alone: what every state pass draws (gpu/program.h, drawFullScreen).
#version 450 core

void main() {
    gl_Position = vec4(vec2((gl_VertexID << 1) & 2, gl_VertexID & 2) * 2.0 - 1.0, 0.0, 1.0);
}
