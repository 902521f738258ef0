// White where covered.
#version 450 core

layout(location = 0) out vec4 o_colour;

void main() { o_colour = vec4(1.0); }
