// Runs the compiled extension for VS Code with a stub of VS Code and of the language client.
//
// Reads a situation as JSON from the arguments, and prints what the extension did: which server it starts, what it
// shows and types, and which pages it opens.
"use strict";
const Module = require("node:module");

const [code, text] = process.argv.slice(2);
const situation = JSON.parse(text);
const done = { messages: [], typed: [], opened: [], beside: [], said: [] };
const commands = {};

const uri = (path) => ({ fsPath: path, toString: () => path });
const python = {
  getActiveEnvironmentPath: () => ({ path: situation.interpreter }),
  resolveEnvironment: async () => ({ executable: { uri: uri(situation.interpreter) } }),
};
const vscode = {
  Uri: { parse: uri },
  commands: {
    registerCommand: (name, run) => (commands[name] = run),
    getCommands: async () => situation.commands ?? [],
    executeCommand: async (name, ...given) => {
      done.beside.push([name, ...given]);
      return situation.answers ?? [];
    },
  },
  env: {
    clipboard: { readText: async () => situation.copied ?? "" },
    asExternalUri: async (address) => address,
    openExternal: (address) => done.opened.push(`${address}`),
  },
  extensions: {
    getExtension: () =>
      situation.interpreter && { activate: async () => ({ environments: python }) },
  },
  window: {
    activeTextEditor: situation.file && {
      document: { uri: uri(situation.file), getText: () => situation.selected ?? "" },
    },
    createOutputChannel: () => ({ info: (line) => done.said.push(line), show: () => undefined }),
    showInputBox: async () => situation.written,
    createTerminal: () => ({
      show: () => undefined,
      sendText: (words, isRun) => done.typed.push([words, isRun]),
    }),
    showErrorMessage: async (message, ...choices) => {
      done.messages.push(message);
      return choices[0];
    },
  },
  workspace: {
    workspaceFolders: situation.folder && [{ uri: uri(situation.folder) }],
    getConfiguration: () => ({ get: (name, value) => situation.settings?.[name] ?? value }),
    onDidChangeConfiguration: () => undefined,
  },
};
class LanguageClient {
  constructor(_id, _name, server, options) {
    done.server = [server.command, ...server.args];
    done.files = options.documentSelector.map((selector) => selector.pattern);
  }
  async start() {
    if (situation.fails) {
      throw new Error("no server");
    }
  }
  async dispose() {}
}
const stubs = {
  vscode,
  "vscode-languageclient/node": { LanguageClient, CloseAction: {}, ErrorAction: {} },
};
const load = Module._load;
Module._load = (name, ...rest) => stubs[name] ?? load(name, ...rest);

async function run() {
  const extension = require(code);
  await extension.activate({ subscriptions: [] });
  await new Promise(setImmediate); // what a message makes somebody choose is done then
  if (situation.run) {
    await commands[situation.run]();
    while (!done.opened.length && !done.beside.length && !done.messages.length) {
      await new Promise((passed) => setTimeout(passed, 20));
    }
  }
  await extension.deactivate();
  console.log(JSON.stringify(done));
}

run();
