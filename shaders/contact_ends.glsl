// Where nodes end the step that contact meets. Programs that only ask where contact would move them (SRS_ASKS, for
// implicit steps) take the start and the way in i_increments, whose sum float32 would round; there they leave the way
// that contact made of it, with the collider that moved the node last, counted from 1, in w.
#ifdef SRS_ASKS
real3 endOf(ivec2 texel) {
    return real3(imageLoad(i_start, texel).xyz) + real3(imageLoad(i_increments, texel).xyz);
}
#else
real3 endOf(ivec2 texel) { return real3(imageLoad(i_positions, texel).xyz); }
#endif
