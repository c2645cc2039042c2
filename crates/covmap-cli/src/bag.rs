//! `bag`: what a bag of ROS 2 has.

use crate::arguments::Bag;
use crate::terminal::say;
use anyhow::Result;
use covmap_bag::{BagInfo, BagReader};
use covmap_io::open_input;
use std::process::ExitCode;

pub(crate) fn run(arguments: &Bag) -> Result<ExitCode> {
    let file = open_input(&arguments.bag)?;
    let info = BagInfo::read(BagReader::new(&arguments.bag, file))?;
    let messages: usize = info.topics.values().map(|topic| topic.messages).sum();
    say::line(format!(
        "{}: {messages} messages in {:.1} s",
        arguments.bag.display(),
        info.seconds()
    ));
    if let Some(cut_off) = &info.cut_off {
        let (messages, fault) = (cut_off.messages, &cut_off.fault);
        say::line(format!("cut off or damaged after {messages} messages: {fault}"));
    }
    let longest = info.topics.keys().map(String::len).max().unwrap_or(0);
    let widest = info.topics.values().map(|topic| topic.type_name.len()).max().unwrap_or(0);
    for (name, topic) in &info.topics {
        let unreadable = match topic.unreadable {
            0 => String::new(),
            many => format!(", {many} of them unreadable"),
        };
        let (type_name, messages) = (&topic.type_name, topic.messages);
        say::line(format!("  {name:longest$}  {type_name:widest$}  {messages:>8}{unreadable}"));
    }
    let frames: Vec<_> = info.transforms.frames().collect();
    if !frames.is_empty() {
        say::line("frames:");
    }
    for (frame, parent, is_static) in frames {
        let how = if is_static { "fixed to" } else { "moves in" };
        say::line(format!("  {frame} {how} {parent}"));
    }
    Ok(ExitCode::SUCCESS)
}
