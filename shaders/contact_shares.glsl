// How far each corner of a triangle moves where its point with these weights moves by 1: twin of cornerShares in
// sim/contact_stage.cpp.
const double kMostShare = 1.25;

dvec3 cornerShares(dvec3 weights, dvec3 inverseMass) {
    dvec3 shares = dvec3(0.0);
    bvec3 full = bvec3(false);
    for (int round = 0; round < 3; ++round) {
        double left = 1.0, sum = 0.0;
        for (int k = 0; k < 3; ++k) {
            left -= full[k] ? weights[k] * kMostShare : 0.0lf;
            sum += full[k] ? 0.0lf : weights[k] * weights[k] * inverseMass[k];
        }
        bool again = false;
        for (int k = 0; k < 3; ++k) {
            if (full[k])
                continue;
            shares[k] = sum > 0.0 ? max(left, 0.0lf) * weights[k] * inverseMass[k] / sum : 0.0lf;
            if (shares[k] > kMostShare) {
                shares[k] = kMostShare;
                full[k] = again = true;
            }
        }
        if (!again)
            break;
    }
    return shares;
}
