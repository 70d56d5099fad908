// SPDX-License-Identifier: Apache-2.0
#include "deploy/run/keys/keys_command.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <memory>
#include <stdexcept>

#include "common/config/scenario_loader.hpp"
#include "common/file/console.hpp"
#include "common/keys/key_folder.hpp"
#include "common/messaging/dds/bus.hpp"
#include "common/process/process.hpp"
#include "deploy/run/keys/key_list.hpp"
#include "deploy/run/keys/key_store.hpp"

namespace sidestep {
namespace {

constexpr const char* kDefaultFolder = "keys";

struct KeysOptions {
  std::string folder = kDefaultFolder;
  std::vector<std::string> words;
  std::string scenario_file;
  double days = 365;
  bool again = false;
};

/// Hosts whose clocks are behind this one's by up to this much accept newly issued keys.
constexpr Duration kClockSlack = std::chrono::minutes(10);

Duration days(double count) { return from_seconds(count * 24 * 3600); }

int init(const KeysOptions& options) {
  const Time now = DdsBus::clock();
  KeyStore::create(options.folder, now - kClockSlack, now + days(options.days));
  print_output(
      "made {}: two certificate authorities, valid until {}\n"
      "{}/private holds their private keys: anyone who can read them can command all robots; no robot needs "
      "them\n",
      options.folder, date_text(now + days(options.days)), options.folder);
  return 0;
}

int issue(const KeysOptions& options) {
  std::vector<Identity> identities = parse_key_list(options.words);
  if (!options.scenario_file.empty()) {
    const auto more = identities_of(load_scenario(options.scenario_file));
    identities.insert(identities.end(), more.begin(), more.end());
  }
  if (identities.empty()) throw UsageError("expected --scenario FILE, or identities: " + identity_forms());
  KeyStore store(options.folder);
  if (options.scenario_file.empty() && !options.again)
    for (const Identity& identity : identities)
      if (store.has(identity))
        throw std::invalid_argument(to_text(identity) + " already has a key; --again makes a new one");
  const Time now = DdsBus::clock();
  std::size_t issued = 0;
  // Printed at the end, so that a missing reader does not leave identities without keys.
  std::string text;
  for (const Identity& identity : identities) {
    if (store.has(identity) && !options.again) continue;
    const std::string folder = store.issue(identity, now - kClockSlack, now + days(options.days));
    if (identities.size() <= 4) text += fmt::format("{}: {}\n", to_text(identity), folder);
    ++issued;
  }
  print_output(
      "{}issued {} key{}{}\n", text, issued, issued == 1 ? "" : "s",
      issued < identities.size() ? fmt::format("; {} already had one", identities.size() - issued) : "");
  return 0;
}

int revoke(const KeysOptions& options) {
  const std::vector<Identity> identities = parse_key_list(options.words);
  if (identities.empty()) throw UsageError("expected identities: " + identity_forms());
  KeyStore store(options.folder);
  std::vector<std::string> unknown;
  std::string text;
  for (const Revocation& done : store.revoke(identities, DdsBus::clock() - kClockSlack)) {
    const std::string name = to_text(done.identity);
    if (done.revoked > 0)
      text += fmt::format("revoked {} key{} of {}\n", done.revoked, done.revoked == 1 ? "" : "s", name);
    else if (done.before > 0)
      text += fmt::format("{}: already revoked\n", name);
    else
      unknown.push_back(name);
  }
  if (!text.empty())
    text += fmt::format(
        "processes that use {}/enclaves refuse them within a second; copy {}/public/crl.pem into the folders "
        "of keys on other hosts\n",
        options.folder, options.folder);
  // The problems below matter more than a missing reader.
  const int output_error = write_text(stdout, text);
  std::vector<std::string> problems;
  if (!unknown.empty())
    problems.push_back(
        fmt::format("no key was issued for {}; `sidestep keys show` lists all", fmt::join(unknown, ", ")));
  for (const IssuedKey& key : store.keys()) {
    if (!key.problem.empty() && !key.is_revoked)
      problems.push_back(
          fmt::format("the owner of this key is unknown, so it is not revoked: {}", key.problem));
  }
  if (!problems.empty()) throw std::invalid_argument(fmt::format("{}", fmt::join(problems, "\n")));
  require_printed(output_error);
  return 0;
}

int show(const KeysOptions& options) {
  const KeyStore store(options.folder);
  const Time now = DdsBus::clock();
  std::string table =
      fmt::format("{:<24} {:<22} {:<10} {}\n", "identity", "valid until", "state", "serial number");
  for (const IssuedKey& key : store.keys()) {
    table += fmt::format("{:<24} {:<22} {:<10} {}\n", key.name,
                         key.problem.empty() ? date_text(key.not_after) : "",
                         key.is_revoked                   ? "revoked"
                         : !key.problem.empty()           ? "unreadable"
                         : key.not_after < now            ? "expired"
                         : key.not_after < now + days(14) ? "expires soon"
                                                          : "valid",
                         key.serial);
  }
  print_output("{}authorities: valid until {}\n", table, date_text(store.authorities_expire()));
  return 0;
}

}  // namespace

void add_keys_command(const CliCommand& root, std::function<int()>& action) {
  const CliCommand keys =
      root.add_subcommand("keys", "Makes the keys that keep strangers out of the network");
  keys.require_subcommand();
  const auto options = std::make_shared<KeysOptions>();
  const auto add = [&](const std::string& name, const std::string& description,
                       int (*run)(const KeysOptions&)) {
    const CliCommand command = keys.add_subcommand(name, description);
    command.on_parsed([options, run, &action] { action = [options, run] { return run(*options); }; });
    return command;
  };
  const auto add_days = [&](const CliCommand& command) {
    command.add_option("--days", options->days, "validity").check(in_range(1.0, 36500.0)).show_default();
  };
  const auto add_folder = [&](const CliCommand& command) {
    command.add_option("--keys", options->folder, "folder that `keys init` has made").show_default();
  };
  const CliCommand init_command = add("init", "Makes a folder with two certificate authorities", init);
  init_command.add_option("FOLDER", options->folder, "new folder").show_default();
  add_days(init_command);
  const CliCommand issue_command = add("issue", "Makes the keys of identities", issue);
  issue_command.add_option("IDENTITY", options->words,
                           identity_forms() + "; 'agent 0-21' makes one key for each");
  issue_command.add_option("--scenario", options->scenario_file,
                           "scenario file: issue keys for all identities that `sidestep run` needs for it");
  issue_command.add_flag("--again", options->again, "make new keys for identities that already have some");
  add_days(issue_command);
  add_folder(issue_command);
  const CliCommand revoke_command =
      add("revoke", "Makes all processes refuse the keys of identities", revoke);
  revoke_command.add_option("IDENTITY", options->words, identity_forms());
  add_folder(revoke_command);
  add_folder(add("show", "Lists all keys that were issued", show));
}

}  // namespace sidestep
