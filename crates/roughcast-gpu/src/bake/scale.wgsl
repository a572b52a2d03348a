// The smallest scale that holds every slope of a map: one look at the map, and one thread that draws the conclusion.
//
// Defined elsewhere: params, map_slope(at), and the bindings peak and packed_stores.

var<workgroup> group_peak: atomic<u32>;

// Floats that are not negative are in the order of their bits.
@compute @workgroup_size(16, 16)
fn find_peak(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    opaque_zero = params.zero;
    var largest = 0.0;
    for (var i = 0u; i < 16u; i++) {
        let at = 4u * id.xy + vec2u(i % 4u, i / 4u);
        if all(at < params.size) {
            let slope = abs(map_slope(at).slope);
            largest = max(largest, max(slope.x, slope.y));
        }
    }
    atomicMax(&group_peak, bitcast<u32>(largest));
    workgroupBarrier();
    if index == 0u {
        atomicMax(&peak, atomicLoad(&group_peak));
    }
}

@compute @workgroup_size(1)
fn set_scale() {
    opaque_zero = params.zero;
    let scale = smallest_scale(bitcast<f32>(atomicLoad(&peak)), params.base_variance);
    let stores = unsigned_stores(scale);
    packed_stores.slope_second = vec4f(stores.slope, stores.second);
    packed_stores.mixed_trace = vec4f(stores.mixed, stores.trace);
    packed_stores.unit_scale = vec4f(stores.unit, scale, 0.0);
}
