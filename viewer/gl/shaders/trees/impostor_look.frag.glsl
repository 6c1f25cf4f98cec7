// A picture for an impostor: what is reflected, and what the light needs to know (impostor.frag.glsl).
in vec3 own_color;
in vec3 own_normal;
in float own_open;
layout(location = 0) out vec4 look;
layout(location = 1) out vec4 facing;

void main() {
  look = vec4(sqrt(clamp(own_color, 0.0, 1.0)), 1.0);
  facing = vec4(normalize(own_normal) * 0.5 + 0.5, own_open);
}
