"""Reads a bag that covmap wrote of a run, with the readers of others, and compares it with the run's trace.

usage: bags.py BAG.mcap RUN/trace.jsonl

- `mcap` checks every checksum, `mcap-ros2-support` decodes every message by the definitions in the bag.
- `rosbags` decodes and encodes every message again: the bytes must be the same.
- Ranges and poses must be those of the trace, scan by scan.
"""

import json
import math
import struct
import sys

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_types_from_msg, get_typestore


def scans_of(trace):
    with open(trace, encoding="utf-8") as lines:
        next(lines)
        events = (json.loads(line) for line in lines)
        return [event["Scan"]["scan"] for event in events if "Scan" in event]


def single(value):
    """The nearest number in single precision."""
    return struct.unpack("f", struct.pack("f", value))[0]


def expected(reading):
    if reading == "NoEcho":
        return math.inf
    return -math.inf if reading == "Missing" else single(reading["Echo"])


def decoded(bag):
    """The messages of each topic, with their stamps, decoded by the definitions in the bag."""
    topics = {}
    with open(bag, "rb") as file:
        reader = make_reader(file, validate_crcs=True, decoder_factories=[DecoderFactory()])
        for _, channel, _, message in reader.iter_decoded_messages(log_time_order=False):
            topics.setdefault(channel.topic, []).append(message)
    return topics


def encode_again(bag):
    """Decodes and encodes all messages with rosbags; returns their number."""
    store = get_typestore(Stores.EMPTY)
    count = 0
    with open(bag, "rb") as file:
        for schema, channel, message in make_reader(file).iter_messages(log_time_order=False):
            if schema.name not in store.fielddefs:
                store.register(get_types_from_msg(schema.data.decode(), schema.name))
            again = store.serialize_cdr(store.deserialize_cdr(message.data, schema.name), schema.name)
            assert bytes(again) == bytes(message.data), f"{channel.topic}: message {count} differs"
            count += 1
    return count


def check(bag, trace):
    scans, topics = scans_of(trace), decoded(bag)
    sonars = sorted(topic for topic in topics if topic.startswith("/sonar_"))
    assert len(sonars) == len(scans[0]["ranges"]), sonars
    for sensor, topic in enumerate(sonars):
        messages = topics[topic]
        assert len(messages) == len(scans), (topic, len(messages), len(scans))
        for scan, message in zip(scans, messages):
            wanted = expected(scan["ranges"][sensor])
            assert message.range == wanted, (topic, message.range, wanted)
    stamp = lambda header: (header.stamp.sec, header.stamp.nanosec)
    poses = {stamp(t.header): t for tf in topics["/tf"] for t in tf.transforms if t.child_frame_id == "base_link"}
    for scan, message in zip(scans, topics[sonars[0]]):
        place = poses[stamp(message.header)].transform.translation
        assert [place.x, place.y] == scan["pose"]["translation"], scan["pose"]
    fixed = {t.child_frame_id: t.header.frame_id for tf in topics["/tf_static"] for t in tf.transforms}
    assert fixed["odom"] == "map" and fixed["sonar_00"] == "base_link", fixed
    for topic in ["/map", "/entropy", "/certificate"]:
        last = topics[topic][-1]
        assert len(last.data) == last.info.width * last.info.height > 0, topic
        assert all(-1 <= cell <= 100 for cell in last.data), topic
    reasons = [m.text for array in topics["/candidates"] for m in array.markers if m.ns == "reason"]
    assert reasons and all("the best of" in reason or "chosen among" in reason for reason in reasons)
    assert len(topics["/path"][-1].poses) >= len(scans)
    return sum(map(len, topics.values()))


if __name__ == "__main__":
    messages = check(*sys.argv[1:3])
    again = encode_again(sys.argv[1])
    assert messages == again, (messages, again)
    print(f"{messages} messages: checksums, types, ranges and poses are right; rosbags encodes each to the same bytes")
