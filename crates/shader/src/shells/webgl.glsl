
out vec4 shown_color;

void main() {
    vec2 pixel = floor(gl_FragCoord.xy);
    vec2 raster = view.tile + vec2(pixel.x, view.size.y - 1.0 - pixel.y) + view.place;
    shown_color = vec4(shown_along(camera_ray(raster)), 1.0);
}
