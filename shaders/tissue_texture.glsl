// Detail of tissue from a texture: colour, normal and parallax. It is read where the fragment rests, so that it moves with the
// tissue: through the model's texture coordinates (SURFACE_UV), or from the three sides along the axes, blended by the rest
// normal (triplanar). Parallax occlusion: the view ray, turned back to rest, is followed into the relief.

uniform sampler2D t_albedo; // rgb; a: roughness
uniform sampler2D t_relief; // xy: normal, 0.5 + 0.5 n; z: height; a: light that reaches the place
uniform vec3 u_albedoScale; // 1 / mean of the texture's colour: the vertices' colours are what it varies
uniform float u_tiles;      // tiles a lattice unit; with texture coordinates those of a tile
uniform vec3 u_tileShift;   // tiles: where the lattice's origin lies in the world's tiles
uniform float u_relief;     // lattice units, from the lowest to the highest

struct Detail {
    vec3 albedo;    // linear, of the texture over its mean
    float roughness;
    vec3 normal;    // at rest, unit
    float open;     // light that reaches into the relief
};

const int kSteps = 8; // of the view ray through the relief

#ifdef SURFACE_UV
/// Texture coordinates a lattice unit, along the surface.
float tilesHere(vec3 rest, vec2 uv) {
    return length(fwidth(uv)) / max(length(fwidth(rest)), 1e-6);
}
#endif

/// Level of the texture that suits a pixel.
float levelOf(vec2 along, vec2 across) {
    vec2 size = vec2(textureSize(t_albedo, 0));
    float widest = max(length(along * size), length(across * size));
    return max(log2(max(widest, 1e-6)), 0.0);
}

/// \param rest lattice units. \param n unit, at rest. \param view towards the eye, at rest.
/// \param tangent, uv of SURFACE_UV: rest tangent with its bitangent's sign in w
#ifdef SURFACE_UV
Detail detailOf(vec3 rest, vec3 n, vec3 view, vec4 tangent, vec2 uv) {
    float level = levelOf(dFdx(uv), dFdy(uv)), scale = tilesHere(rest, uv);
    vec3 t = normalize(tangent.xyz - n * dot(n, tangent.xyz)), b = tangent.w * cross(n, t);
    vec2 slide = -vec2(dot(view, t), dot(view, b)) / max(dot(view, n), 0.3) * (u_relief * scale);
    vec2 at = uv;
    float depth = 0.0, before = 0.0, gap = 0.0, last = 0.0;
    for (int i = 0; i < kSteps && level < 3.0; ++i) {
        depth = 1.0 - textureLod(t_relief, at, level).z;
        gap = float(i) / float(kSteps) - depth;
        if (gap >= 0.0)
            break;
        last = gap;
        before = float(i) / float(kSteps);
        at = uv + slide * float(i + 1) / float(kSteps);
    }
    if (gap >= 0.0 && last < 0.0)
        at = uv + slide * (before - last / (gap - last) / float(kSteps));
    vec4 albedo = textureLod(t_albedo, at, level), relief = textureLod(t_relief, at, level);
    vec2 slope = 2.0 * relief.xy - 1.0;
    vec3 normal = slope.x * t + slope.y * b + sqrt(max(1.0 - dot(slope, slope), 0.05)) * n;
    return Detail(albedo.rgb * u_albedoScale, albedo.a, normalize(normal), relief.a);
}
#else
vec3 sideWeights(vec3 n) {
    vec3 w = n * n;
    w = max(w * w - 0.02, 0.0);
    return w / (w.x + w.y + w.z);
}

vec4 fromSides(sampler2D map, vec3 at, vec3 w, float level) {
    vec4 sum = vec4(0.0);
    if (w.x > 0.0)
        sum += w.x * textureLod(map, at.zy, level);
    if (w.y > 0.0)
        sum += w.y * textureLod(map, at.xz, level);
    if (w.z > 0.0)
        sum += w.z * textureLod(map, at.xy, level);
    return sum;
}

/// Slope of the relief in rest space, of one side. \param u, v axes of the side
vec3 slopeOf(vec2 at, vec3 u, vec3 v, float level) {
    vec2 n = 2.0 * textureLod(t_relief, at, level).xy - 1.0;
    return (n.x * u + n.y * v) / sqrt(max(1.0 - dot(n, n), 0.05));
}

Detail detailOf(vec3 rest, vec3 n, vec3 view) {
    vec3 at = rest * u_tiles + u_tileShift, w = sideWeights(n), along = dFdx(at), across = dFdy(at);
    float level = max(levelOf(vec2(length(along), 0.0), vec2(length(across), 0.0)) - 0.5, 0.0);
    vec3 slide = -(view - n * dot(view, n)) / max(dot(view, n), 0.3) * (u_relief * u_tiles);
    vec3 start = at;
    float last = 0.0, gap = 0.0, before = 0.0;
    for (int i = 0; i < kSteps && level < 3.0; ++i) {
        gap = float(i) / float(kSteps) - (1.0 - fromSides(t_relief, at, w, level).z);
        if (gap >= 0.0)
            break;
        last = gap;
        before = float(i) / float(kSteps);
        at = start + slide * float(i + 1) / float(kSteps);
    }
    if (gap >= 0.0 && last < 0.0)
        at = start + slide * (before - last / (gap - last) / float(kSteps));
    vec4 albedo = fromSides(t_albedo, at, w, level);
    vec3 slope = vec3(0.0);
    if (w.x > 0.0)
        slope += w.x * slopeOf(at.zy, vec3(0.0, 0.0, 1.0), vec3(0.0, 1.0, 0.0), level);
    if (w.y > 0.0)
        slope += w.y * slopeOf(at.xz, vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, 1.0), level);
    if (w.z > 0.0)
        slope += w.z * slopeOf(at.xy, vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), level);
    return Detail(albedo.rgb * u_albedoScale, albedo.a, normalize(n + slope - n * dot(n, slope)),
                  fromSides(t_relief, at, w, level).a);
}
#endif
