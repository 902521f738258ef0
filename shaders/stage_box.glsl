// Where a place lies in the box of a deformation that is drawn in two stages (render/stage_box.h).
uniform mat4 u_stageFromObject;
uniform float u_stageCylinder;     // radius that the box is wound around; 0: it is not
uniform vec3 u_stageHalf;
uniform vec3 u_seamLow, u_seamHigh; // widths at its faces; 0: no seam there

/// Below 0 outside of the box; else how far through the seam: 0 on a face that has one, 1 and more beyond.
float stageDepth(vec3 object) {
    vec3 q = (u_stageFromObject * vec4(object, 1.0)).xyz;
    if (u_stageCylinder > 0.0)
        q = vec3(length(q.xz) - u_stageCylinder, q.y, u_stageCylinder * atan(q.z, q.x));
    vec3 low = q + u_stageHalf, high = u_stageHalf - q;
    float depth = 2.0;
    for (int axis = 0; axis < 3; ++axis) {
        if (min(low[axis], high[axis]) < 0.0)
            return -1.0;
        if (u_seamLow[axis] > 0.0)
            depth = min(depth, low[axis] / u_seamLow[axis]);
        if (u_seamHigh[axis] > 0.0)
            depth = min(depth, high[axis] / u_seamHigh[axis]);
    }
    return depth;
}
