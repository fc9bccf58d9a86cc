
// A ray turned about the vertical line through the camera's target.
Ray turned_ray(Ray ray, float angle) {
    float c = cos(angle);
    float s = sin(angle);
    mat3 turn = mat3(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0);
    vec3 target = triple(TARGET);
    return Ray(turn * (ray.origin - target) + target, turn * ray.direction);
}

void mainImage(out vec4 fragColor, in vec2 fragCoord) {
    view = View(iResolution.xy, vec2(0.0), vec2(0.5), iTime, SHOW_LIT);
    float angle = iMouse.z > 0.0 ? 6.2831853 * (0.5 - iMouse.x / iResolution.x) : 0.0;
    Ray ray = camera_ray(vec2(fragCoord.x, iResolution.y - fragCoord.y));
    fragColor = vec4(shown_along(turned_ray(ray, angle)), 1.0);
}
