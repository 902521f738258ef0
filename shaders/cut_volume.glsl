// Colours of a cut's face from a volume at the rest position (render/cut_volume.h).
// RAYCAST_VOLUME: grey values under a window, colours of labels, colours.
#include "raycast_constants.h"
uniform sampler3D t_cutVolume;
uniform mat4 u_volumeFromObject; // voxels: the middle of the first lies at 0
#if RAYCAST_VOLUME == SRS_VOLUME_GREY
uniform vec2 u_window; // values that are black and white
#endif

vec3 linearOfSrgb(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c));
}

/// Linear colour; w: 1, or 0 where the volume says nothing.
vec4 cutVolumeAt(vec3 rest) {
    vec3 at = (u_volumeFromObject * vec4(rest, 1.0)).xyz, size = vec3(textureSize(t_cutVolume, 0));
    if (any(lessThan(at, vec3(-0.5))) || any(greaterThan(at, size - 0.5)))
        return vec4(0.0);
#if RAYCAST_VOLUME == SRS_VOLUME_COLOURS
    return vec4(linearOfSrgb(textureLod(t_cutVolume, (at + 0.5) / size, 0.0).rgb), 1.0);
#elif RAYCAST_VOLUME == SRS_VOLUME_GREY
    float share = clamp((texture(t_cutVolume, (at + 0.5) / size).x - u_window.x) / (u_window.y - u_window.x), 0.0, 1.0);
    return vec4(linearOfSrgb(vec3(share)), 1.0);
#else
    vec4 label = texelFetch(t_cutVolume, clamp(ivec3(floor(at + 0.5)), ivec3(0), ivec3(size) - 1), 0);
    return vec4(linearOfSrgb(label.rgb), label.a);
#endif
}
