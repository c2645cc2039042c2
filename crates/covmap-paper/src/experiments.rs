//! The campaigns behind the figures and claims, and their quick variants.

use crate::error::Result;
use crate::runs::{MOST_COUNTS, Runs, measured_until_explored};
use crate::session::{Series, Session};
use covmap_campaign::{Campaign, Setting, Starts};
use covmap_plan::Strategy;
use std::fmt::Write;
use std::path::Path;

/// The number of scans after which a quick run ends.
pub(super) const QUICK_SCANS: usize = 1000;

/// The names of the two configurations; the first decides the verdicts.
pub(crate) const PAPER: &str = "paper";
pub(crate) const B21R: &str = "b21r";

/// Returns the campaign of a figure, from its file, or its quick variant, whose runs are cut short.
pub(crate) fn campaign(name: &str, quick: bool) -> Result<Campaign> {
    let variant = if quick { "-quick" } else { "" };
    let mut campaign = Campaign::read(Path::new(&format!("configs/{name}{variant}.ron")))?;
    if quick {
        campaign.settings.iter_mut().for_each(|setting| setting.max_scans = Some(QUICK_SCANS));
    }
    Ok(campaign)
}

impl Series {
    /// Returns the setting of a configuration that measures at view-points only, or while driving.
    pub fn setting(&self, config: &str, driving: bool) -> Option<&Setting> {
        self.campaign.settings.iter().find(|setting| {
            let stem = setting.config.file_stem().unwrap_or_default();
            stem == config && setting.while_driving.is_some() == driving
        })
    }

    /// Returns the runs of such a setting; empty if there is no such setting.
    pub fn runs(&self, config: &str, driving: bool) -> Runs {
        let setting = self.setting(config, driving);
        setting.map_or_else(Runs::default, |setting| {
            Runs::of(&self.campaign, &setting.name, &self.records)
        })
    }
}

/// Runs extended counting with n* of footnote 2, in the worlds and with the settings of Table 1.
///
/// n* is the largest discounted number of measurements that a cell had when CL first explored it.
pub(crate) fn n_star(session: &Session<'_>, table_1: &Series) -> Result<Series> {
    let mut campaign = table_1.campaign.clone();
    campaign.name.push_str("-n-star");
    let mut settings = Vec::new();
    for setting in &table_1.campaign.settings {
        let runs = Runs::of(&table_1.campaign, &setting.name, &table_1.records);
        let [_, weight] = measured_until_explored(&runs);
        let times = weight.max(1.0).ceil().min(MOST_COUNTS);
        // The count of Table 1 has been run already.
        let times = if (times - 50.0).abs() < 0.5 { 51.0 } else { times };
        // Another count makes another campaign, in a folder of its own.
        let _ = write!(campaign.name, "-{times}");
        let strategy = Strategy::Count { times, half_distance: Some(2.0) };
        settings.push(Setting { strategies: Some(vec![strategy]), ..setting.clone() });
    }
    // Long runs: one seed from every start.
    campaign.seeds.count = 1;
    campaign.settings = settings;
    campaign.strategies = Vec::new();
    session.run(campaign)
}

/// Returns the campaign of claim 17, with the worlds that the user named.
pub(crate) fn worlds(session: &Session<'_>) -> Result<Campaign> {
    let mut campaign = campaign("worlds", session.quick)?;
    for (name, file) in session.worlds {
        campaign.replace_world(name, file)?;
    }
    Ok(campaign)
}

/// Returns all campaigns that are known before any of them is run.
pub(crate) fn campaigns(session: &Session<'_>) -> Result<Vec<Campaign>> {
    let named = ["table1", "fig6", "fig7"].map(|name| campaign(name, session.quick));
    named.into_iter().chain([worlds(session), ablated(session)]).collect()
}

/// Runs the ablation in a small world: each setting changes one of our readings.
pub(crate) fn ablation(session: &Session<'_>) -> Result<Series> {
    session.run(ablated(session)?)
}

fn ablated(session: &Session<'_>) -> Result<Campaign> {
    let mut campaign = campaign("ablation", false)?;
    if session.quick {
        campaign.name.push_str("-quick");
        campaign.starts = Starts::Given;
        // Quick: coarse cells, and all runs cut short.
        campaign.settings.retain(|setting| !setting.overrides.contains_key("resolution"));
        campaign.worlds.iter_mut().for_each(|world| world.resolution = Some(0.2));
        campaign.settings.iter_mut().for_each(|setting| setting.max_scans = Some(QUICK_SCANS));
    }
    Ok(campaign)
}
