#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/tables/table_specs.h"

namespace surefield {

/// What the runs of one set of scenes have measured, over seeds.
class OwnResults {
 public:
  /// `runs` must outlive it; `set` is the folder of the runs (TableSpec::set).
  OwnResults(const ReproducedRuns& runs, std::string set) : runs_(runs), set_(std::move(set)) {}

  /// Of one scene, in the unit of the table; nullopt where it was not run.
  std::optional<Spread> value(const TableVariant& variant, const TableMetric& metric,
                              const std::string& scene) const;
  /// How often that is spent, for metrics that say so (TableMetric::times).
  std::optional<Spread> count(const TableVariant& variant, const TableMetric& metric,
                              const std::string& scene) const;
  /// The mean over scenes, seed by seed; nullopt where no seed was run in all of them.
  std::optional<Spread> mean(const TableVariant& variant, const TableMetric& metric,
                             const std::vector<std::string>& scenes) const;

 private:
  std::string place_of(const TableVariant& variant, const std::string& scene) const {
    return set_ + "/" + scene + "/" + variant.folder;
  }

  const ReproducedRuns& runs_;
  std::string set_;
};

}  // namespace surefield
