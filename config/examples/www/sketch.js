// Draws the wind 60 times a second. Beside this file stands p5.min.js, of `npm pack p5@1` (package/lib), or of
// https://cdn.jsdelivr.net/npm/p5@1/lib/p5.min.js. Served at /site/ with [http] folder = the folder of this file.
let wind = null;

function connect() {
  const socket = new WebSocket(location.origin.replace("http", "ws") + "/ws");
  socket.onopen = () => socket.send(JSON.stringify({ wind: 60 }));
  socket.onmessage = (event) => (wind = JSON.parse(event.data).wind);
  socket.onclose = () => setTimeout(connect, 1000); // the daemon is started again
}

function setup() {
  createCanvas(windowWidth, windowHeight);
  connect();
}

function draw() {
  background(16, 24, 32, 24); // what was drawn fades
  if (!wind) return;
  stroke(255, 255 * wind.live, 255 * wind.gust_norm);
  translate(width / 2, height / 2); // u: toward the east, v: toward the north, m/s
  line(0, 0, (wind.u * height) / 40, (-wind.v * height) / 40);
}
