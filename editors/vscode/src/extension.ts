/** Starts the language server of the grader, and shows robots beside their files. */

import { type ChildProcess, spawn } from "node:child_process";
import { existsSync } from "node:fs";
import { basename, dirname, join, resolve } from "node:path";
import { createInterface } from "node:readline";
import * as vscode from "vscode";
import { CloseAction, ErrorAction, LanguageClient } from "vscode-languageclient/node";

const INSTALLATION = "pip install 'urdf-grader[editor]'";
const ROBOT = /\.(urdf|xacro)$/;
const ENDINGS = "urdf,xacro,srdf,sdf,world,launch,rviz,xml,yaml,yml,py,cpp,cc,cxx,hpp,hh,h";
const FILES = [`**/*.{${ENDINGS}}`, "**/CMakeLists.txt"]; // VS Code knows no braces in braces
const INTEGRATED_BROWSER = "workbench.action.browser.open"; // of VS Code 1.109 and newer
const PROGRAM = process.platform === "win32" ? "Scripts/grader.exe" : "bin/grader";

let client: LanguageClient | undefined;
let last: Promise<void> = Promise.resolve(); // start of the server: one at a time
let view: ChildProcess | undefined;
let output: vscode.LogOutputChannel;

export async function activate(context: vscode.ExtensionContext): Promise<void> {
  output = vscode.window.createOutputChannel("Grader", { log: true });
  context.subscriptions.push(
    output,
    vscode.commands.registerCommand("grader.view", showRobot),
    vscode.commands.registerCommand("grader.restart", restart),
    vscode.commands.registerCommand("grader.explainLog", explainLog),
    vscode.workspace.onDidChangeConfiguration(
      (change) => change.affectsConfiguration("grader") && restart(),
    ),
  );
  await restart();
}

export async function deactivate(): Promise<void> {
  view?.kill("SIGINT");
  await client?.dispose();
}

function restart(): Promise<void> {
  last = last.then(start);
  return last;
}

/** Starts the server, in place of the one that runs. */
async function start(): Promise<void> {
  await client?.dispose().catch(() => undefined); // one that did not start cannot be stopped
  const command = await findCommand();
  const args = ["lsp", ...rubricOptions()];
  output.info(`starts ${[command, ...args].join(" ")}`);
  const options = {
    documentSelector: FILES.map((pattern) => ({ scheme: "file", pattern })),
    outputChannel: output,
    initializationFailedHandler: () => false,
    errorHandler: {
      error: () => ({ action: ErrorAction.Continue }),
      closed: () => ({ action: CloseAction.DoNotRestart, message: "The server has ended." }),
    },
  };
  client = new Client("grader", "Grader", { command, args, options: { cwd: folder() } }, options);
  await client.start().catch(() => void offerInstallation(`'${command} lsp' does not start.`));
}

/** A client that shows the errors of a server that runs; others are answered otherwise. */
class Client extends LanguageClient {
  override error(message: string, data?: unknown, shows?: boolean | "force"): void {
    super.error(message, data, this.isRunning() && shows);
  }
}

/** Returns the grader of the settings, of the workspace's environment, or of the path. */
async function findCommand(): Promise<string> {
  const root = folder();
  const setting = settingOf("command");
  if (setting) {
    return /[\\/]/.test(setting) ? resolve(root ?? "", setting) : setting;
  }
  const candidates = root ? [join(root, ".venv", PROGRAM)] : [];
  const interpreter = await chosenInterpreter();
  if (interpreter) {
    candidates.push(join(dirname(interpreter), basename(PROGRAM)));
  }
  return candidates.find(existsSync) ?? "grader";
}

/** Returns the path of the interpreter that the Python extension chose, if that is there. */
async function chosenInterpreter(): Promise<string | undefined> {
  const python = await vscode.extensions.getExtension("ms-python.python")?.activate();
  const environments = python?.environments;
  const root = vscode.workspace.workspaceFolders?.[0]?.uri;
  const chosen = environments?.getActiveEnvironmentPath(root);
  const environment = chosen && (await environments.resolveEnvironment(chosen));
  return environment?.executable?.uri?.fsPath;
}

function folder(): string | undefined {
  return vscode.workspace.workspaceFolders?.[0]?.uri.fsPath;
}

function settingOf(name: "command" | "rubric"): string {
  return vscode.workspace.getConfiguration("grader").get(name, "");
}

function rubricOptions(): string[] {
  const rubric = settingOf("rubric");
  return rubric ? ["--rubric", rubric] : [];
}

async function offerInstallation(problem: string): Promise<void> {
  const [install, settings] = ["Type it in a terminal", "Settings"];
  const text = `${problem} Install it in the environment of the workspace: ${INSTALLATION}`;
  const choice = await vscode.window.showErrorMessage(text, install, settings);
  if (choice === install) {
    const terminal = vscode.window.createTerminal("Grader");
    terminal.show();
    terminal.sendText(INSTALLATION, false);
  } else if (choice === settings) {
    await vscode.commands.executeCommand("workbench.action.openSettings", "grader.command");
  }
}

/** Explains an output of a terminal: the selected text, else the clipboard, or what is typed. */
async function explainLog(): Promise<void> {
  const editor = vscode.window.activeTextEditor;
  const selected = editor?.document.getText(editor.selection);
  const prompt = "The output to explain: it stays on this machine";
  const text =
    selected ||
    (await vscode.env.clipboard.readText()) ||
    (await vscode.window.showInputBox({ prompt }));
  if (text) {
    const lines = await vscode.commands.executeCommand<string[]>("grader.explain", text);
    lines.forEach((line) => output.info(line));
    output.show(true);
  }
}

/** Runs `grader view` of the robot in the editor, else of the workspace, and opens its page. */
async function showRobot(file?: vscode.Uri): Promise<void> {
  const path = (file ?? vscode.window.activeTextEditor?.document.uri)?.fsPath ?? "";
  const shown = ROBOT.test(path) ? path : folder();
  if (!shown) {
    return void vscode.window.showErrorMessage("Open a URDF or a folder first.");
  }
  view?.kill("SIGINT");
  const command = await findCommand();
  const args = ["view", shown, "--no-browser", ...rubricOptions()];
  const started = spawn(command, args, { cwd: folder() });
  view = started;
  started.on("error", () => offerInstallation(`'${command}' does not start.`));
  let said = "";
  createInterface(started.stderr).on("line", (line) => output.info((said = line)));
  createInterface(started.stdout).once("line", openPage);
  started.on("close", (code) => code && vscode.window.showErrorMessage(said));
}

/** Opens a page beside the editor, where VS Code has a browser that shows pages as a browser does. */
async function openPage(address: string): Promise<void> {
  const url = await vscode.env.asExternalUri(vscode.Uri.parse(address));
  if ((await vscode.commands.getCommands(true)).includes(INTEGRATED_BROWSER)) {
    const options = { url: url.toString(true), openToSide: true };
    await vscode.commands.executeCommand(INTEGRATED_BROWSER, options);
  } else {
    await vscode.env.openExternal(url);
  }
}
