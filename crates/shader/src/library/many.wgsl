// The distance of a point from the box that two quads begin with: its middle and half its edges.
fn apart_of(p: vec3<f32>, a: vec4<f32>, b: vec4<f32>) -> f32 {
    return length(max(abs(p - a.xyz) - vec3<f32>(a.w, b.x, b.y), vec3<f32>(0.0)));
}

// The node of the part at which the way down ends that always takes the nearer of two boxes: a first guess of the nearest.
fn guess(p: vec3<f32>) -> i32 {
    var node: i32 = NODES;
    loop {
        if (parameters[node + 7] >= 0.0) {
            break;
        }
        let left: i32 = node + NODE_SIZE;
        let b: vec4<f32> = quad(left + 4);
        // A leaf is one node long; what else there is knows its end.
        let right: i32 = select(left + NODE_SIZE, i32(b.z), b.w < 0.0);
        let is_right: bool = apart_of(p, quad(right), quad(right + 4)) < apart_of(p, quad(left), b);
        node = select(left, right, is_right);
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
        let b: vec4<f32> = quad(node + 4);
        let is_leaf: bool = b.w >= 0.0;
        let is_near: bool = apart_of(p, quad(node), b) < distance_so_far;
        if (is_near && is_leaf) {
            break;
        }
        if (is_near || is_leaf) {
            node += NODE_SIZE;
        } else {
            node = i32(b.z);
        }
    }
    return node;
}

// The first node from one on that holds a part, or the end of all nodes: a walk by what a ray passes before it ends.
fn leaf_on(first: i32, ray: Ray, inverse: vec3<f32>, end: f32) -> i32 {
    var node: i32 = first;
    loop {
        if (node >= NODES_END) {
            break;
        }
        let b: vec4<f32> = quad(node + 4);
        let is_leaf: bool = b.w >= 0.0;
        let span: vec2<f32> = span_in(ray, inverse, quad(node), b);
        let is_met: bool = span.x <= min(span.y, end);
        if (is_met && is_leaf) {
            break;
        }
        if (is_met || is_leaf) {
            node += NODE_SIZE;
        } else {
            node = i32(b.z);
        }
    }
    return node;
}

// The part of a ray inside the box that two quads begin with; nothing if the end comes before the beginning.
fn span_in(ray: Ray, inverse: vec3<f32>, a: vec4<f32>, b: vec4<f32>) -> vec2<f32> {
    let middle: vec3<f32> = (a.xyz - ray.origin) * inverse;
    let half: vec3<f32> = vec3<f32>(a.w, b.x, b.y) * abs(inverse);
    let near: vec3<f32> = middle - half;
    let far: vec3<f32> = middle + half;
    return vec2<f32>(max(max(max(near.x, near.y), near.z), 0.0), min(min(far.x, far.y), far.z));
}

// The part of a ray that the box which two quads begin with may dim.
fn penumbra_of(ray: Ray, a: vec4<f32>, b: vec4<f32>, sharpness: f32) -> vec2<f32> {
    return penumbra(ray, a.xyz, length(vec3<f32>(a.w, b.x, b.y)), sharpness);
}

// The first node from one on that holds a part, or the end of all nodes: a walk by what a ray comes near to before it ends.
fn leaf_around(first: i32, ray: Ray, end: f32, sharpness: f32) -> i32 {
    var node: i32 = first;
    loop {
        if (node >= NODES_END) {
            break;
        }
        let b: vec4<f32> = quad(node + 4);
        let is_leaf: bool = b.w >= 0.0;
        let span: vec2<f32> = penumbra_of(ray, quad(node), b, sharpness);
        let is_met: bool = span.x <= min(span.y, end);
        if (is_met && is_leaf) {
            break;
        }
        if (is_met || is_leaf) {
            node += NODE_SIZE;
        } else {
            node = i32(b.z);
        }
    }
    return node;
}

// How far a ray may go from a point before it meets a part, and which one that is: none outside of the box of one that has a slope
// in its box only, which is near then instead, and no surface.
fn reach_at(p: vec3<f32>, part: i32) -> vec2<f32> {
    let place: i32 = PARTS + PART_SIZE * part;
    let first: i32 = i32(parameters[place + 9]);
    if (FORMULA_COUNT > 0 && parameters[place + 10] > 0.0) {
        let far: f32 = apart(p, place);
        if (far > 0.0) {
            return vec2<f32>(far + parameters[place + 7], f32(-2 - part));
        }
        return vec2<f32>(part_value(part, first, p) * parameters[place + 6], f32(part));
    }
    return vec2<f32>(part_value(part, first, p), f32(part));
}

// How far a ray may go from a point in a direction before it meets a part.
fn free_at(p: vec3<f32>, direction: vec3<f32>, part: i32) -> f32 {
    let place: i32 = PARTS + PART_SIZE * part;
    let scale: f32 = parameters[SCALE];
    if (FORMULA_COUNT == 0 || parameters[place + 10] == 0.0) {
        return part_value(part, i32(parameters[place + 9]), p) * scale;
    }
    let far: f32 = apart(p, place);
    if (far > 0.0) {
        return (far + parameters[place + 7]) * scale;
    }
    return ahead(part_gradient(part, p), direction, parameters[place + 11], parameters[place + 6] * scale);
}

// The first part that a ray meets before it ends. Each is marched alone, in its box.
fn first_met(ray: Ray, end: f32) -> March {
    let inverse: vec3<f32> = inverse_of(ray.direction);
    var met: March = March(end, -1, 0, false, vec4<f32>(0.0));
    var node: i32 = NODES;
    loop {
        node = leaf_on(node, ray, inverse, met.distance);
        if (node >= NODES_END) {
            break;
        }
        let b: vec4<f32> = quad(node + 4);
        let span: vec2<f32> = span_in(ray, inverse, quad(node), b);
        let steps: i32 = met.steps;
        let one: March = march(ray, span.x, min(span.y, met.distance), i32(b.w));
        if (one.part >= 0 || one.is_unresolved) {
            met = one;
        }
        met.steps = steps + one.steps;
        node += NODE_SIZE;
    }
    return met;
}

// What the parts leave of a light along a ray.
fn light_past(ray: Ray, end: f32, shade_of: Shade) -> f32 {
    let inverse: vec3<f32> = inverse_of(ray.direction);
    let sharpness: f32 = shade_of.sharpness * parameters[SCALE];
    var factor: f32 = 1.0;
    var node: i32 = NODES;
    loop {
        if (shade_of.is_soft) {
            node = leaf_around(node, ray, end, sharpness);
        } else {
            node = leaf_on(node, ray, inverse, end);
        }
        if (node >= NODES_END) {
            break;
        }
        let a: vec4<f32> = quad(node);
        let b: vec4<f32> = quad(node + 4);
        var span: vec2<f32> = span_in(ray, inverse, a, b);
        if (shade_of.is_soft) {
            span = penumbra_of(ray, a, b, sharpness);
        }
        factor = min(factor, light_along(ray, span.x, min(span.y, end), shade_of, i32(b.w)));
        if (factor == 0.0) {
            break;
        }
        node += NODE_SIZE;
    }
    return factor;
}

// The nearer of what is so far and the part of a node, by the values of the field.
fn value_of(node: i32, p: vec3<f32>, so_far: vec2<f32>) -> vec2<f32> {
    let b: vec4<f32> = quad(node + 4);
    return closer(so_far, part_value(i32(b.w), i32(b.z), p), b.w);
}

// The field of all parts at a point where it is less than `most`, and the part that it belongs to.
fn unscaled(p: vec3<f32>, most: f32) -> vec2<f32> {
    var d: vec2<f32> = vec2<f32>(most, -1.0);
    if (most == FAR) {
        d = value_of(guess(p), p, d);
    }
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
