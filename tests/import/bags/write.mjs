// Writes rig.mcap by the library of MCAP (@mcap/core), with messages of ROS 2 in CDR by Foxglove's own writer,
// and prints the messages for `make`, which puts them into rig.db3. None of it is finray's.
import {McapWriter} from "@mcap/core";
import rosmsg from "@foxglove/rosmsg";
import {MessageWriter} from "@foxglove/rosmsg2-serialization";
import zstd from "@foxglove/wasm-zstd";
import fs from "node:fs";

const line = "=".repeat(80);
const GAUGES = `std_msgs/MultiArrayLayout layout
float64[] data
${line}
MSG: std_msgs/MultiArrayLayout
std_msgs/MultiArrayDimension[] dim
uint32 data_offset
${line}
MSG: std_msgs/MultiArrayDimension
string label
uint32 size
uint32 stride
`;
const WRENCH = `std_msgs/Header header
geometry_msgs/Wrench wrench
${line}
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
${line}
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
${line}
MSG: geometry_msgs/Wrench
geometry_msgs/Vector3 force
geometry_msgs/Vector3 torque
${line}
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
`;
const TYPES = [["/gauges", "std_msgs/msg/Float64MultiArray", GAUGES], ["/ft", "geometry_msgs/msg/WrenchStamped", WRENCH]];

// rig.csv: stamp in ns, two gauges, force along x and y.
const rows = fs.readFileSync("rig.csv", "utf8").trim().split("\n").slice(1).map(text => text.split(","));

async function main() {
  await zstd.isLoaded;
  const parts = [], file = {size: 0n, position() { return this.size; },
    async write(bytes) { parts.push(Buffer.from(bytes)); this.size += BigInt(bytes.byteLength); }};
  const writer = new McapWriter({writable: file, chunkSize: 1500,
    compressChunk: data => ({compression: "zstd", compressedData: zstd.compress(data, data.byteLength)})});
  await writer.start({profile: "ros2", library: "finray's tests"});
  const topics = [];
  for (const [topic, name, text] of TYPES) {
    const schemaId = await writer.registerSchema({name, encoding: "ros2msg", data: Buffer.from(text)});
    const id = await writer.registerChannel({schemaId, topic, messageEncoding: "cdr", metadata: new Map([["offered_qos_profiles", ""]])});
    topics.push({topic, name, text, id, writer: new MessageWriter(rosmsg.parse(text, {ros2: true})), messages: []});
  }
  for (const [sequence, [ns, g1, g2, fx, fy]] of rows.entries()) {
    const stamp = BigInt(ns), layout = {dim: [{label: "gauges", size: 2, stride: 2}], data_offset: 0};
    const header = {stamp: {sec: Number(stamp / 1000000000n), nanosec: Number(stamp % 1000000000n)}, frame_id: "ft300"};
    const zero = {x: 0, y: 0, z: 0};
    const values = [{layout, data: [+g1, +g2]}, {header, wrench: {force: {...zero, x: +fx, y: +fy}, torque: zero}}];
    for (const [k, topic] of topics.entries()) {
      const data = topic.writer.writeMessage(values[k]);
      await writer.addMessage({channelId: topic.id, sequence, logTime: stamp, publishTime: stamp, data});
      topic.messages.push([ns, Buffer.from(data).toString("hex")]);
    }
  }
  await writer.end();
  fs.writeFileSync("rig.mcap", Buffer.concat(parts));
  console.log(JSON.stringify(topics.map(({topic, name, text, messages}) => ({topic, name, text, messages}))));
}
main();
