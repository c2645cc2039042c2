// Reads a bag that covmap wrote, with the reader and the decoder of Foxglove.
//
// usage: node bags.mjs BAG.mcap
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";

// The packages are in the folder from which this is called.
const require = createRequire(`${process.cwd()}/`);
const { McapIndexedReader } = require("@mcap/core");
const { parse } = require("@foxglove/rosmsg");
const { MessageReader } = require("@foxglove/rosmsg2-serialization");
const { decompress } = require("fzstd");

const bytes = readFileSync(process.argv[2]);
const readable = {
  size: async () => BigInt(bytes.length),
  read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
};
const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };
const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const decoders = new Map();
for (const channel of reader.channelsById.values()) {
  const schema = reader.schemasById.get(channel.schemaId);
  const definition = parse(new TextDecoder().decode(schema.data), { ros2: true });
  decoders.set(channel.id, [channel.topic, new MessageReader(definition)]);
}
let messages = 0;
let cells = 0;
for await (const message of reader.readMessages()) {
  const [topic, decoder] = decoders.get(message.channelId);
  const decoded = decoder.readMessage(message.data);
  messages += 1;
  if (topic === "/map") {
    if (decoded.data.length !== decoded.info.width * decoded.info.height) throw new Error("/map");
    cells = decoded.data.length;
  }
}
const counted = Number(reader.statistics.messageCount);
if (messages !== counted || cells === 0) throw new Error(`${messages} of ${counted} messages, ${cells} cells`);
console.log(`${messages} messages, a map of ${cells} cells`);
