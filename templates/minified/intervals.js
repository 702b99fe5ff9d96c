let ALL=[-1/0,1/0];

let span=n=>n.length?n:[n,n];

function side(n){const[s,t]=span(n);return s>0?1:t<0?-1:0}

function out(u,N,b=Number.EPSILON){return(u-=Math.abs(u)*b+Number.MIN_VALUE)<=(N+=Math.abs(N)*b+Number.MIN_VALUE)?[u,N]:[-1/0,1/0]}

function plus(t,n){let e=t,l=t,u=n,g=n;return t.length&&(e=t[0],l=t[1]),n.length&&(u=n[0],g=n[1]),out(e+u,l+g)}

function times(t,n){let e=t,h=t,a=n,i=n;t.length&&(e=t[0],h=t[1]),n.length&&(a=n[0],i=n[1]);let l=e*a||0,m=e*i||0,o=h*a||0,u=h*i||0;return out(Math.min(l,m,o,u),Math.max(l,m,o,u))}

function power(t,a){const[u,o]=span(t),h=u**Math.abs(a),m=o**Math.abs(a);let[n,M]=a%2||u>0||o<0?out(Math.min(h,m),Math.max(h,m),4*Number.EPSILON):[0,out(h,Math.max(h,m),4*Number.EPSILON)[1]];return u>=0&&(n=Math.max(n,0)),a>0?[n,M]:n>0||M<0?out(1/M,1/n):0===n?out(1/M,1/0):ALL}

function rising(u,n){return n.length?out(u(n[0]),u(n[1]),4*Number.EPSILON):out(u(n),u(n),4*Number.EPSILON)}

function cosine(a){const[t,h]=span(a),M=Math.ceil(t/Math.PI-1e-9),e=Math.floor(h/Math.PI+1e-9);if(!(e-M<1&&Math.abs(t)+Math.abs(h)<1e6))return[-1,1];const[n,s]=[Math.cos(t),Math.cos(h)],o=M===e&&1-2*Math.abs(M%2);return[-1===o?-1:Math.min(n,s)-4*Number.EPSILON,1===o?1:Math.max(n,s)+4*Number.EPSILON]}

function sums(t,n){let e=[],o=[],l=[];let r=0;for(let u=0;u<t.length;u++){if(!t[u])continue;let a=n(u);for(let t=0;t<a.length;t++){let n=a[t],u=n;n.length&&(u=n[1],n=n[0]),r?(e[t]+=n,o[t]+=u,l[t]+=Math.max(-n,u)):(e[t]=n,o[t]=u,l[t]=Math.max(-n,u))}r+=1}return e.map((t,n)=>{let u=r*Number.EPSILON*l[n];return out(e[n]-u,o[n]+u)})}

function isolate(e,s,n,t,i){let l=(n,t)=>{const[i,l]=e.enclose(s,[n,t]);if(side(i)||side(l))return[side(i),side(l)];let o=(n+t)/2,[r]=e.enclose(s,[o,o]);return[side(plus(r,times(l,plus([n,t],-o)))),0]},o=[],r=[];let u=2e3,c=n,f=0,[p,a]=[n,t].map((e,s)=>l(e,e)[0]||Math.sign(i[s]));let d=(e,s,n)=>{const[t,i]=l(e,s),r=(e+s)/2;t||i||!n||--u<0?o.push([e,s,t,i]):(d(e,r,n-1),d(r,s,n-1))},h=e.seen[s],m=h?.[0]===n&&h.at(-1)===t?h:[n,t];if(n<t)for(let e=1;e<m.length;e++)d(m[e-1],m[e],48);e.seen[s]??=[n,...o.map(([,e])=>e)];for(const[e,s,n,i]of[...o,[t,t,a,0]])if(!n&&i&&f*i>=0)f=i;else{if(!n&&e<s)return[null,e,s];if(e>c?!(p*n):p*n<0)return[null,c,e];p*n<0&&r.push([c,e,n]),[c,p,f]=[s,n,0]}return r}
