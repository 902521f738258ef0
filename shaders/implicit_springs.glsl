// The springs of the implicit step: one a node and direction, its stiffness as n times the root of that along it minus
// that across it, and that across it (ImplicitSystem::Spring).
layout(std430) buffer b_springs { vec4 b_spring[]; }; // SRS_NEIGHBOURS times nodes

vec4 springOf(int node, int d) { return b_spring[d * u_nodes + node]; }
