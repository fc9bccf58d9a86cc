// The node of the part at which the way down ends that always takes the nearer of two boxes: a first guess of the nearest.
fn guess(p: vec3<f32>) -> i32 {
    var node: i32 = NODES;
    loop {
        if (parameters[node + 7] >= 0.0) {
            break;
        }
        let left: i32 = node + NODE_SIZE;
        // A leaf is one node long; what else there is knows its end.
        var right: i32 = left + NODE_SIZE;
        if (parameters[left + 7] < 0.0) {
            right = i32(parameters[left + 6]);
        }
        node = select(left, right, apart(p, right) < apart(p, left));
    }
    return node;
}

// The first node from one on that holds a part and is nearer than some distance, or the end of all nodes.
fn leaf_from(first: i32, p: vec3<f32>, distance_so_far: f32) -> i32 {
    var node: i32 = first;
    loop {
        if (node >= NODES_END) {
            break;
        }
        let is_leaf: bool = parameters[node + 7] >= 0.0;
        let is_near: bool = apart(p, node) < distance_so_far;
        if (is_near && is_leaf) {
            break;
        }
        if (is_near || is_leaf) {
            node += NODE_SIZE;
        } else {
            node = i32(parameters[node + 6]);
        }
    }
    return node;
}

// The nearer of what is so far and the part of a node, as rays may go. Outside of the box of a part that has a slope in its box
// only, the box is what is near, which is no surface.
fn reach_of(node: i32, p: vec3<f32>, so_far: vec2<f32>) -> vec2<f32> {
    let part: i32 = i32(parameters[node + 7]);
    let place: i32 = PARTS + PART_SIZE * part;
    if (FORMULA_COUNT > 0 && parameters[place + 10] > 0.0) {
        let far: f32 = apart(p, place);
        if (far > 0.0) {
            return closer(so_far, far + parameters[place + 7], f32(-2 - part));
        }
        return closer(so_far, part_value(part, i32(parameters[node + 6]), p) * parameters[place + 6], f32(part));
    }
    return closer(so_far, part_value(part, i32(parameters[node + 6]), p), f32(part));
}

// How far a ray may go from a point before it meets a marched part, and which one: -2 for the box of the first, -3 for that of
// the second, and so on.
fn nearest(p: vec3<f32>) -> vec2<f32> {
    let first: i32 = guess(p);
    var d: vec2<f32> = reach_of(first, p, vec2<f32>(FAR, -1.0));
    var node: i32 = NODES;
    loop {
        node = leaf_from(node, p, d.x);
        if (node >= NODES_END) {
            break;
        }
        d = reach_of(node, p, d);
        node += NODE_SIZE;
    }
    return d;
}

// The nearer of what is so far and the part of a node, by the values of the field.
fn value_of(node: i32, p: vec3<f32>, so_far: vec2<f32>) -> vec2<f32> {
    let part: i32 = i32(parameters[node + 7]);
    return closer(so_far, part_value(part, i32(parameters[node + 6]), p), f32(part));
}

// The field of all parts at a point, and the part that it belongs to.
fn unscaled(p: vec3<f32>) -> vec2<f32> {
    var d: vec2<f32> = value_of(guess(p), p, vec2<f32>(FAR, -1.0));
    var node: i32 = NODES;
    loop {
        node = leaf_from(node, p, d.x);
        if (node >= NODES_END) {
            break;
        }
        d = value_of(node, p, d);
        node += NODE_SIZE;
    }
    return d;
}

// How far a ray may go from a point in a direction, as far as the part of a node is concerned, and no farther than what is so far.
fn free_of(node: i32, p: vec3<f32>, direction: vec3<f32>, so_far: f32) -> f32 {
    let part: i32 = i32(parameters[node + 7]);
    let place: i32 = PARTS + PART_SIZE * part;
    let scale: f32 = parameters[SCALE];
    if (parameters[place + 10] > 0.0) {
        let far: f32 = apart(p, place);
        if (far > 0.0) {
            return min(so_far, (far + parameters[place + 7]) * scale);
        }
        let here: vec4<f32> = part_gradient(part, p);
        return min(so_far, ahead(here, direction, parameters[place + 11], parameters[place + 6] * scale));
    }
    return min(so_far, part_value(part, i32(parameters[node + 6]), p) * scale);
}

// How far a ray may go from a point in a direction.
fn free_ahead(p: vec3<f32>, direction: vec3<f32>) -> f32 {
    // Without formulas nobody asks.
    if (FORMULA_COUNT == 0) {
        return FAR;
    }
    var free: f32 = free_of(guess(p), p, direction, FAR);
    var node: i32 = NODES;
    loop {
        node = leaf_from(node, p, free / parameters[SCALE]);
        if (node >= NODES_END) {
            break;
        }
        free = free_of(node, p, direction, free);
        node += NODE_SIZE;
    }
    return free;
}
