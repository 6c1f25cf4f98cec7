layout(location = 0) in float x_m;
layout(location = 1) in float y_m;
layout(location = 2) in float z_m;
layout(location = 6) in float level;

out float heat;
out float along;

uniform int columns;
uniform int rows;

void main() {
  heat = level;
  along = float(gl_VertexID / columns) / float(max(rows - 1, 1));
  gl_Position = to_clip * vec4(x_m, y_m, z_m, 1.0);
}
