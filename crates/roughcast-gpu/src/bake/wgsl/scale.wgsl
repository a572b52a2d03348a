// Finds the smallest scale that represents every slope of a map, and the automatic slope limit. One pass reads the map;
// a single workgroup then evaluates the result.
//
// Defined elsewhere: params, map_slope(at), and the bindings survey and packed_stores.

struct Survey {
    // The largest component, as bits: non-negative floats compare in the same order as their bits.
    peak: atomic<u32>,
    sampled: atomic<u32>,
    histogram: array<atomic<u32>, SLOPE_BINS>,
}

var<workgroup> group_peak: atomic<u32>;
var<workgroup> group_histogram: array<atomic<u32>, SLOPE_BINS>;

// Used in the pass over the map, where the limit is not known yet.
fn slope_limit() -> f32 {
    return params.max_slope;
}

@compute @workgroup_size(16, 16)
fn look(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    opaque_zero = params.zero;
    let stride = params.survey_stride;
    var largest = 0.0;
    for (var i = 0u; i < 16u; i++) {
        let at = 4u * id.xy + vec2u(i % 4u, i / 4u);
        if all(at < params.size) {
            let slope = map_slope(at).slope;
            largest = max(largest, max(abs(slope.x), abs(slope.y)));
            if stride > 0u {
                if at.x % stride == at.y % stride {
                    let squares = rounded2(slope * slope);
                    atomicAdd(&group_histogram[slope_bin(squares.x + squares.y)], 1u);
                }
            }
        }
    }
    atomicMax(&group_peak, bitcast<u32>(largest));
    workgroupBarrier();
    if index == 0u {
        atomicMax(&survey.peak, atomicLoad(&group_peak));
    }
    if stride > 0u {
        for (var bin = index; bin < SLOPE_BINS; bin += 256u) {
            let count = atomicLoad(&group_histogram[bin]);
            if count > 0u {
                atomicAdd(&survey.histogram[bin], count);
                atomicAdd(&survey.sampled, count);
            }
        }
    }
}

// Bins that each thread sums; 256 threads cover all bins.
const BINS_A_THREAD: u32 = (SLOPE_BINS + 255u) / 256u;

var<workgroup> counts_of_threads: array<u32, 256>;

// The slope length that only the steepest texels exceed.
fn slope_exceeded() -> f32 {
    let allowed = atomicLoad(&survey.sampled) / STEEP_ONE_IN;
    var above = 0u;
    var thread = 255u;
    while thread > 0u && above + counts_of_threads[thread] <= allowed {
        above += counts_of_threads[thread];
        thread -= 1u;
    }
    let first = thread * BINS_A_THREAD;
    var bin = min(first + BINS_A_THREAD, SLOPE_BINS) - 1u;
    while bin > first {
        above += atomicLoad(&survey.histogram[bin]);
        if above > allowed {
            break;
        }
        bin -= 1u;
    }
    return upper_edge_of_slope_bin(bin);
}

@compute @workgroup_size(256)
fn set_scale(@builtin(local_invocation_index) index: u32) {
    opaque_zero = params.zero;
    var sum = 0u;
    for (var i = 0u; i < BINS_A_THREAD; i++) {
        let bin = index * BINS_A_THREAD + i;
        if bin < SLOPE_BINS {
            sum += atomicLoad(&survey.histogram[bin]);
        }
    }
    counts_of_threads[index] = sum;
    workgroupBarrier();
    if index > 0u {
        return;
    }
    let peak = bitcast<f32>(atomicLoad(&survey.peak));
    var limit = params.max_slope;
    if params.survey_stride > 0u {
        limit = automatic_limit(slope_exceeded(), peak, params.base_variance, params.max_slope);
    }
    let scale = smallest_scale(min(peak, limit), params.base_variance);
    let stores = unsigned_stores(scale);
    packed_stores.slope_second = vec4f(stores.slope, stores.second);
    packed_stores.mixed_trace = vec4f(stores.mixed, stores.trace);
    packed_stores.unit_scale_limit = vec4f(stores.unit, scale, limit);
}
