// Depth maps as the body's implicit function (CS07 section 6.1; render/depth_maps.h), in voxels. Twin: depthField in
// render/depth_twin.cpp. f = H - d is positive before the surface, which is our sign as it is printed.
// RAYCAST_FIELD: one pair of maps, or a cube of three.
uniform sampler3D t_depths; // a layer an axis: depth of the near end, of the far one
uniform vec3 u_gridMost;    // voxels: middle of the last
#if RAYCAST_FIELD == SRS_FIELD_DEPTH
uniform int u_depthAxis;
const int kDepthLayers = 1;
#else
const int kDepthLayers = 3;
#endif

int depthAxis(int layer) {
#if RAYCAST_FIELD == SRS_FIELD_DEPTH
    return u_depthAxis;
#else
    return layer;
#endif
}

/// Where a place lies in a layer's plane.
vec2 depthTexel(vec3 at, int axis) {
    return (vec2(at[(axis + 1) % 3], at[(axis + 2) % 3]) + 0.5) / vec2(textureSize(t_depths, 0).xy);
}

/// rho min(|f|, |g|): inside only where both are.
float combined(float f, float g) {
    float least = min(abs(f), abs(g));
    return f < 0.0 && g < 0.0 ? -least : least;
}

/// Depths of both ends of a layer's axis.
vec2 depthEnds(vec3 at, int layer) {
    return texture(t_depths, vec3(depthTexel(at, depthAxis(layer)), (float(layer) + 0.5) / float(kDepthLayers))).xy;
}

/// f of the maps from both ends of a layer's axis.
vec2 depthParts(vec3 at, int layer) {
    vec2 ends = depthEnds(at, layer);
    float depth = at[depthAxis(layer)];
    return vec2(ends.x - depth, depth - ends.y);
}

float depthField(vec3 at) {
    float f = -1e9;
    for (int layer = 0; layer < kDepthLayers; ++layer) {
        vec2 parts = depthParts(at, layer);
        f = combined(combined(f, parts.x), parts.y);
    }
    return f;
}

/// Along the gradient of f: that of the map which sees the place most squarely, of those whose own f is the field's there. (The
/// gradient of the minimum takes up maps that see the place from aside, at their rims.) 0: none is.
vec3 depthGradient(vec3 at) {
    float f = depthField(at), least = 1e9;
    vec3 found = vec3(0.0);
    for (int layer = 0; layer < kDepthLayers; ++layer) {
        int axis = depthAxis(layer);
        vec2 parts = depthParts(at, layer);
        vec3 nearSlope = vec3(0.0), farSlope = vec3(0.0);
        for (int k = 1; k < 3; ++k) {
            vec3 by = vec3(0.0);
            by[(axis + k) % 3] = 1.0;
            vec2 slope = 0.5 * (depthEnds(at + by, layer) - depthEnds(at - by, layer));
            nearSlope[(axis + k) % 3] = slope.x;
            farSlope[(axis + k) % 3] = -slope.y;
        }
        nearSlope[axis] = -1.0;
        farSlope[axis] = 1.0;
        if (abs(parts.x - f) < 1.0 && length(nearSlope) < least) {
            least = length(nearSlope);
            found = nearSlope;
        }
        if (abs(parts.y - f) < 1.0 && length(farSlope) < least) {
            least = length(farSlope);
            found = farSlope;
        }
    }
    return found;
}

/// Where the colour of a place is kept: that of the map whose surface is nearest along its axis.
vec3 depthColourAt(vec3 at) {
    float least = 1e9, map = 0.0;
    vec2 texel = vec2(0.0);
    for (int layer = 0; layer < kDepthLayers; ++layer) {
        vec2 parts = abs(depthParts(at, layer));
        if (min(parts.x, parts.y) < least) {
            least = min(parts.x, parts.y);
            texel = depthTexel(at, depthAxis(layer));
            map = float(2 * layer) + (parts.y < parts.x ? 1.0 : 0.0);
        }
    }
    return vec3(texel, (map + 0.5) / float(2 * kDepthLayers));
}
