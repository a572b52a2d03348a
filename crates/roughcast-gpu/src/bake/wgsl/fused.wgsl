// Several levels in one dispatch, each a quarter of the previous one: a thread averages 4x4 texels in its registers,
// then the 16x16 threads of a workgroup average their results in workgroup memory.
//
// Defined elsewhere: HALVINGS, params, input_averages(at), average_of_quad(...), store_0(at, averages) ... store_6.
// Each store function knows its level's size and ignores texels outside of it and levels that are not requested.

// 256 averages of 32 bytes: 8 KiB.
var<workgroup> held_low: array<vec4f, 256>;
var<workgroup> held_high: array<vec4f, 256>;

fn hold(index: u32, averages: Averages) {
    held_low[index] = vec4f(averages.mean, averages.covariance.xy);
    held_high[index] = vec4f(averages.covariance.z, averages.normal);
}

fn held(index: u32) -> Averages {
    let low = held_low[index];
    let high = held_high[index];
    return Averages(low.xy, vec3f(low.zw, high.x), high.yzw);
}

fn finest(at: vec2u) -> Averages {
    if any(at >= params.size) {
        return Averages();
    }
    let averages = input_averages(at);
    store_0(at, averages);
    return averages;
}

fn quad(at: vec2u) -> Averages {
    var four: array<Averages, 4>;
    for (var i = 0u; i < 4u; i++) {
        four[i] = finest(2u * at + vec2u(i & 1u, i >> 1u));
    }
    let averages = average_of_quad(four[0], four[1], four[2], four[3]);
    store_1(at, averages);
    return averages;
}

// The average of four averages in workgroup memory whose threads are `stride` apart; it replaces the first of them.
fn average_of_held(at: vec2u, stride: u32) -> Averages {
    let first = 2u * stride * (16u * at.y + at.x);
    let averages = average_of_quad(
        held(first),
        held(first + stride),
        held(first + 16u * stride),
        held(first + 17u * stride),
    );
    hold(first, averages);
    return averages;
}

@compute @workgroup_size(16, 16)
fn fused(
    @builtin(workgroup_id) group: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) index: u32,
) {
    opaque_zero = params.zero;
    let at = 16u * group.xy + local.xy;
    var four: array<Averages, 4>;
    for (var i = 0u; i < 4u; i++) {
        four[i] = quad(2u * at + vec2u(i & 1u, i >> 1u));
    }
    let averages = average_of_quad(four[0], four[1], four[2], four[3]);
    store_2(at, averages);
    if HALVINGS <= 2u {
        return;
    }
    hold(index, averages);
    workgroupBarrier();
    if index < 64u {
        let inner = vec2u(index % 8u, index / 8u);
        store_3(8u * group.xy + inner, average_of_held(inner, 1u));
    }
    workgroupBarrier();
    if index < 16u {
        let inner = vec2u(index % 4u, index / 4u);
        store_4(4u * group.xy + inner, average_of_held(inner, 2u));
    }
    workgroupBarrier();
    if index < 4u {
        let inner = vec2u(index % 2u, index / 2u);
        store_5(2u * group.xy + inner, average_of_held(inner, 4u));
    }
    workgroupBarrier();
    if index == 0u {
        store_6(group.xy, average_of_held(vec2u(0u), 8u));
    }
}
