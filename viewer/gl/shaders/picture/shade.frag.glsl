// For things so small, or that change so slowly, that the light is computed for each vertex.
in vec3 shade;
out vec4 color;

void main() { color = vec4(shade, 1.0); }
