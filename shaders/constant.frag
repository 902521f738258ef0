// Fills with one value: what `serosa doctor` draws to see whether float targets render and blend.
#version 450 core

uniform vec4 u_value;
layout(location = 0) out vec4 o_value;

void main() { o_value = u_value; }
