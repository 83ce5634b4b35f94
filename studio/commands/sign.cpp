#include <memory>
#include <string>

#include "recordings/signature.h"
#include "studio/commands/command.h"
#include "studio/commands/console.h"
#include "studio/output/printable.h"

namespace ctpm::commands {
namespace {

struct SignArguments {
  std::string file, key, name;
};

int run_sign(const SignArguments& arguments) {
  const Result<recordings::Signature> signature =
      recordings::sign_session(arguments.file, arguments.key, arguments.name);
  if (!signature) return print_errors(signature.errors());
  print("%s: signed with the key %s\n", arguments.file.c_str(), signature->key.c_str());
  return exit_good;
}

int run_key(const std::string& file) {
  if (const Result<Done> made = recordings::make_key(file); !made) return print_errors(made.errors());
  const Result<std::string> key = recordings::read_public_key(file);
  if (!key) return print_errors(key.errors());
  print("%s: the secret key; who has it signs in your name\n%s.pub: the public key %s\n", file.c_str(), file.c_str(),
        key->c_str());
  return exit_good;
}

}  // namespace

Command add_sign(CLI::App& program) {
  auto arguments = std::make_shared<SignArguments>();
  CLI::App* app = program.add_subcommand("sign", "Signs a session, so that `verify` finds every later change.");
  app->footer("Example: ctpm sign exam.ctpm --key me.pem --name \"A. Trainee\"");
  app->add_option("session", arguments->file, "Session file (.ctpm)")->required();
  app->add_option("--key", arguments->key, "File with the secret Ed25519 key (PEM)")->required();
  app->add_option("--name", arguments->name, "Name that stands beside the key");
  return {app, [arguments] { return run_sign(*arguments); }};
}

Command add_key(CLI::App& program) {
  auto file = std::make_shared<std::string>();
  CLI::App* app = program.add_subcommand("key", "Makes a key to sign sessions with.");
  app->footer("Example: ctpm key me.pem");
  app->add_option("file", *file, "File for the secret key (PEM); FILE.pub gets the public one")->required();
  return {app, [file] { return run_key(*file); }};
}

}  // namespace ctpm::commands
