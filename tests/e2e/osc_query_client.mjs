// A program that knows only where an OSCQuery server is: prints as JSON what npm's `oscquery` finds there, and then what it
// is sent by WebSocket of each address that it listens to.
//
// usage: node osc_query_client.mjs FOLDER_OF_TOOLS PORT MESSAGES ADDRESS...
import { createRequire } from "node:module";
import path from "node:path";

const [tools, port, wanted, ...addresses] = process.argv.slice(2);
const require = createRequire(path.join(tools, "package.json"));
const { OSCQueryDiscovery } = require("oscquery");
const { WebSocket } = require("ws");

const service = await new OSCQueryDiscovery().queryNewService("127.0.0.1", Number(port));
const methods = service.flat().map((method) => ({
  path: method.full_path, description: method.description, access: method.access, arguments: method.arguments,
}));

const socket = new WebSocket(`ws://127.0.0.1:${port}/`);
const messages = [];
socket.on("open", () => {
  for (const address of addresses) socket.send(JSON.stringify({ COMMAND: "LISTEN", DATA: address }));
});
socket.on("message", (data, isBinary) => {
  if (isBinary) messages.push(data.toString("hex"));
  if (messages.length < Number(wanted)) return;
  socket.close();
  console.log(JSON.stringify({ host: service.hostInfo, methods, messages }));
  process.exit(0);
});
